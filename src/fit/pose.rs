//! Steps of a pose.

use glam::{DMat3, DQuat, DVec3};

/// A pose turned about its local axes and moved along them by the last six parameters of a step.
pub(super) fn moved(rotation: DMat3, center: DVec3, step: &[f64]) -> (DMat3, DVec3) {
    let (turn, shift) = (DVec3::from_slice(&step[..3]), DVec3::from_slice(&step[3..6]));
    let turned = DQuat::from_mat3(&rotation) * DQuat::from_scaled_axis(turn);
    (DMat3::from_quat(turned.normalize()), center + rotation * shift)
}
