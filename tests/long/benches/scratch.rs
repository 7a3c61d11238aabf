//! scratch
use divan::{Bencher, black_box};
use hamel::{flows, so3, Rotor};
use hamel::flows::{Flow, Attitude};
fn main(){divan::main()}
const N: usize=64;
fn go(b: Bencher, f: impl Fn([f64;9],[f64;3])->([f64;9],[f64;3])) {
    b.counter(N).bench_local(|| { let mut s=(so3::exp(black_box([0.3,-1.1,0.6])), black_box([1.0,-1.0,1.0])); for _ in 0..N { s=f(s.0,s.1);} s });
}
#[divan::bench(sample_count=500)] fn axial(b: Bencher){ go(b,|r,mut p|{ let r=flows::axial(r,&mut p,black_box([1.0,1.0,0.5]),2,5e-3); (r,p)}) }
#[divan::bench(sample_count=500)] fn axial_flow(b: Bencher){ let rotor=black_box(Rotor::of_moments([1.0,1.0,0.5])); go(b,|r,mut p|{ let r=Flow::Turns.turn(&rotor,r,&mut p,5e-3); (r,p)}) }
#[divan::bench(sample_count=500)] fn axes(b: Bencher){ go(b,|r,mut p|{ let r=flows::axes(r,&mut p,black_box([1.0,1.7,2.4]),5e-3); (r,p)}) }
#[divan::bench(sample_count=500)] fn exact(b: Bencher){ go(b,|r,mut p|{ let r=flows::exact(r,&mut p,black_box([1.0,1.7,2.4]),5e-3); (r,p)}) }
#[divan::bench(sample_count=500)] fn retract(b: Bencher){ go(b,|r,p|{ (so3::retract(r,p.map(|p|5e-3*p)),p)}) }
#[divan::bench(sample_count=500)] fn polar(b: Bencher){ go(b,|r,p|{ (so3::polar(r),p)}) }
#[divan::bench(sample_count=500)] fn about(b: Bencher){ go(b,|r,p|{ (r.turned_about(2, flows::attitude::SineCosine::of(1e-3*p[0])),p)}) }
#[divan::bench(sample_count=500)] fn general(b: Bencher){ go(b,|r,p|{ let x=Rotor::general(black_box([1.0+r[0]*1e-3,0.0,0.0,0.0,1.7,0.0,0.0,0.0,2.4])); ([x.moments[0];9],p)}) }
