//! x
use quell_belt::simulation::*;
use quell_model::*;
fn main() {
    let n: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    let mut steps=0; let mut ev=0; let mut periods=0.0;
    let t=std::time::Instant::now();
    for _ in 0..n { for d in [0.1,0.3,0.5,0.8] { for r in [5.0,10.0] {
        let law=LawKind::Stribeck.build(&[0.4,0.2857,0.2]).unwrap();
        let b=Belt::new(0.005,1.0,0.05,law,vec![Dither{direction:Direction::Tangential,waveform:Waveform::Sine,amplitude:d,frequency_ratio:r,phase:0.0}]).unwrap();
        let e=simulate(&b,Start::REST,200.0,1e-10,&mut ()).unwrap();
        steps+=e.steps; ev+=e.events; periods+=r*200.0/std::f64::consts::TAU;
    }}}
    println!("{} us/period, steps/period {}, events/period {}", t.elapsed().as_secs_f64()*1e6/periods, steps as f64/periods, ev as f64/periods);
}
