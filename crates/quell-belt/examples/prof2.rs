//! x
use quell_belt::simulation::*;
use quell_model::*;
#[derive(Default)] struct C{slip:u64,stick:u64,sl:f64,st:f64}
impl Observer for C { fn segment(&mut self,s:&Segment<'_>){ if s.slip_sign()==0 {self.stick+=1;self.st+=s.duration();} else {self.slip+=1;self.sl+=s.duration();} } }
fn main() {
    let mut periods=0.0; let mut c=C::default();
    for d in [0.1,0.3,0.5,0.8] { for r in [5.0,10.0] {
        let law=LawKind::Stribeck.build(&[0.4,0.2857,0.2]).unwrap();
        let b=Belt::new(0.005,1.0,0.05,law,vec![Dither{direction:Direction::Tangential,waveform:Waveform::Sine,amplitude:d,frequency_ratio:r,phase:0.0}]).unwrap();
        let mut k=C::default();
        simulate(&b,Start::REST,200.0,1e-10,&mut k).unwrap();
        println!("D {d} R {r}: slip {} stick {} stick fraction {}",k.slip,k.stick,k.st/200.0);
        periods+=r*200.0/std::f64::consts::TAU; c.slip+=k.slip; c.stick+=k.stick;
    }}
    println!("slip/period {} stick/period {}", c.slip as f64/periods, c.stick as f64/periods);
}
