//! fidget-mesh on a model.

use fidget::context::Tree;
use fidget::render::ThreadPool;
use fidget::vm::VmShape;
use fidget_mesh::{Mesh, Octree, Settings};

use crate::lean::lean;
use crate::models::Model;

/// What meshes with fidget's VM, 2^`depth` cells along the model's cube.
pub fn fidget(model: &Model, depth: u32, threads: usize) -> impl FnMut() -> (Octree, Mesh) + Send {
    let tree: Tree = lean(model).unwrap_or_else(|| model.solid.to_fidget().expect("a model without fillets"));
    let shape = VmShape::from(tree).try_into().expect("no variables but x, y and z");
    let mut settings = Settings { depth: depth as u8, ..Settings::default() };
    // Its box is that from −1 to 1.
    for axis in 0..3 {
        settings.world_to_model[(axis, axis)] = model.half as f32;
    }
    settings.threads = (threads > 1).then_some(&ThreadPool::Global);
    move || {
        let octree = Octree::build(&shape, &settings).expect("nobody cancels");
        let mesh = octree.walk_dual();
        (octree, mesh)
    }
}
