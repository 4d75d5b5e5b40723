use glam::DVec3;
use rvachev::*;
use std::time::Instant;
fn main() {
    let m1 = Solid::superellipsoid(DVec3::new(1.0, 0.8, 0.6), 0.3, 0.7);
    for n in [64u32, 128, 256] {
        let t = Instant::now();
        let b = Bounds::new(DVec3::splat(-1.25), DVec3::splat(1.25));
        let mesh = m1.mesh_with(&MeshSettings { cell: CellSize::Length(2.5 / f64::from(n)), bounds: Some(b) }, &Run { threads: 1, ..Run::default() }).unwrap();
        let el = t.elapsed();
        let r = mesh.check();
        let v = 2.0*1.0*0.8*0.6*0.3*0.7 * beta(0.15, 1.3) * beta(0.35, 1.35);
        println!("{n}: {el:?} {} tris closed {} manifold {} vol err {:.5}%", mesh.triangles().len(), r.is_closed(), r.is_manifold(), 100.0*(r.volume/v-1.0));
    }
    let prog = m1.field_program().unwrap();
    let n = 65536;
    let mut s = 1u64; let mut rnd = || { s = s.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); ((s>>40) as f32 / 16777216.0 - 0.5)*2.5 };
    let x: Vec<f32> = (0..n).map(|_| rnd()).collect(); let y: Vec<f32> = (0..n).map(|_| rnd()).collect(); let z: Vec<f32> = (0..n).map(|_| rnd()).collect();
    let tape = Tape::new(&prog, &Bounds::new(DVec3::splat(-1.25), DVec3::splat(1.25)));
    let mut ev = Evaluator::new(); let mut out = vec![0f32; n];
    for _ in 0..5 { let t = Instant::now(); for _ in 0..10 { ev.values(&tape, &x,&y,&z,&mut out);} println!("value {:.2} ns", t.elapsed().as_secs_f64()*1e9/(10.0*n as f64)); }
    let mut g = [vec![0f32;n],vec![0f32;n],vec![0f32;n],vec![0f32;n]];
    for _ in 0..5 { let t = Instant::now(); for _ in 0..10 { let [a,b,c,d]=&mut g; ev.gradients(&tape,&x,&y,&z,Gradients{value:a,dx:b,dy:c,dz:d});} println!("grad {:.2} ns", t.elapsed().as_secs_f64()*1e9/(10.0*n as f64)); }
    let mut worst=0f64; for i in 0..2000 { let p=DVec3::new(x[i] as f64,y[i] as f64,z[i] as f64); worst=worst.max((m1.value(p).unwrap()-out[i] as f64).abs()); }
    println!("worst {worst:e}");
}
fn gamma(x:f64)->f64{ if x<0.5 {std::f64::consts::PI/((std::f64::consts::PI*x).sin()*gamma(1.0-x))} else {let x=x-1.0;let g=7.0;let c=[0.99999999999980993,676.5203681218851,-1259.1392167224028,771.32342877765313,-176.61502916214059,12.507343278686905,-0.13857109526572012,9.9843695780195716e-6,1.5056327351493116e-7];let mut a=c[0];for (i,ci) in c.iter().enumerate().skip(1){a+=ci/(x+i as f64);}let t=x+g+0.5;(2.0*std::f64::consts::PI).sqrt()*t.powf(x+0.5)*(-t).exp()*a}}
fn beta(a:f64,b:f64)->f64{gamma(a)*gamma(b)/gamma(a+b)}
