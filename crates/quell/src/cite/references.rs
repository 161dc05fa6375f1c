//! The published sources that can be cited; `references.bib` contains the same sources.

/// A published source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// Key in `references.bib`.
    pub key: &'static str,
    /// The full reference.
    pub reference: &'static str,
}

/// The dissertation that states the problem and whose equations are numbered here.
pub const MICHAUX_2005: Source = Source {
    key: "michaux2005",
    reference: "M. A. Michaux: Suppression of Friction-Induced Oscillations through Use of \
                High-Frequency Dither Signals. PhD thesis, Georgia Institute of Technology, 2005",
};
/// Averaging of the belt with tangential dither, and the Stribeck law used here.
pub const THOMSEN_1999: Source = Source {
    key: "thomsen1999",
    reference: "J. J. Thomsen: Using fast vibrations to quench friction-induced oscillations. \
                Journal of Sound and Vibration 228(5), 1079–1102, 1999",
};
/// Stick-slip of the undithered belt.
pub const THOMSEN_FIDLIN_2003: Source = Source {
    key: "thomsen2003",
    reference: "J. J. Thomsen, A. Fidlin: Analytical approximations for stick–slip vibration \
                amplitudes. International Journal of Non-Linear Mechanics 38(3), 389–403, 2003",
};
/// Experiments with dither against squeal of a disc brake.
pub const CUNEFARE_GRAF_2002: Source = Source {
    key: "cunefare2002",
    reference: "K. A. Cunefare, A. J. Graf: Experimental active control of automotive disc brake \
                rotor squeal using dither. Journal of Sound and Vibration 250(4), 579–590, 2002",
};
/// Describing functions of a nonlinearity under several sinusoids and noise.
pub const GELB_VANDER_VELDE_1968: Source = Source {
    key: "gelb1968",
    reference: "A. Gelb, W. E. Vander Velde: Multiple-Input Describing Functions and Nonlinear System Design. McGraw-Hill, \
                New York, 1968",
};
/// Friction in machines, with a decreasing (Stribeck) and a viscous part.
pub const ARMSTRONG_HELOUVRY_1994: Source = Source {
    key: "armstrong1994",
    reference: "B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit: A survey of models, analysis tools and \
                compensation methods for the control of machines with friction. Automatica 30(7), 1083–1138, 1994",
};
/// Friction by bristles that deflect before they slip (LuGre).
pub const CANUDAS_DE_WIT_1995: Source = Source {
    key: "canudas1995",
    reference: "C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky: A new model for control of systems with \
                friction. IEEE Transactions on Automatic Control 40(3), 419–425, 1995",
};
/// What a citation of [`CANUDAS_DE_WIT_1995`] is for.
pub(super) const LUGRE: &str = "LuGre friction, whose bristles are a state";
/// Integration by Taylor series with step size control.
pub const JORBA_ZOU_2005: Source = Source {
    key: "jorba2005",
    reference: "À. Jorba, M. Zou: A software package for the numerical integration of ODEs by \
                means of high-order Taylor methods. Experimental Mathematics 14(1), 99–117, 2005",
};
/// Solutions of differential equations with set-valued right-hand sides.
pub const FILIPPOV_1988: Source = Source {
    key: "filippov1988",
    reference: "A. F. Filippov: Differential Equations with Discontinuous Righthand Sides. \
                Kluwer, Dordrecht, 1988",
};
/// The Hann window and other windows.
pub const HARRIS_1978: Source = Source {
    key: "harris1978",
    reference: "F. J. Harris: On the use of windows for harmonic analysis with the discrete \
                Fourier transform. Proceedings of the IEEE 66(1), 51–83, 1978",
};
/// Averages and rotation numbers of quasi-periodic motion.
pub const DAS_SAIKI_SANDER_YORKE_2017: Source = Source {
    key: "das2017",
    reference: "S. Das, Y. Saiki, E. Sander, J. A. Yorke: Quantitative quasiperiodicity. \
                Nonlinearity 30(11), 4111–4140, 2017",
};
/// Basin stability: the share of starts that reach a state, as a complement to linear stability.
pub const MENCK_2013: Source = Source {
    key: "menck2013",
    reference: "P. J. Menck, J. Heitzig, N. Marwan, J. Kurths: How basin stability complements the \
                linear-stability paradigm. Nature Physics 9(2), 89–92, 2013",
};
/// Confidence interval of a sampled share.
pub const WILSON_1927: Source = Source {
    key: "wilson1927",
    reference: "E. B. Wilson: Probable inference, the law of succession, and statistical inference. \
                Journal of the American Statistical Association 22(158), 209–212, 1927",
};
/// Frequencies and shapes of annular plates.
pub const VOGEL_SKINNER_1965: Source = Source {
    key: "vogel1965",
    reference: "S. M. Vogel, D. W. Skinner: Natural frequencies of transversely vibrating uniform \
                annular plates. Journal of Applied Mechanics 32, 926–931, 1965",
};
/// A disc under a moving mass, spring and damper.
pub const IWAN_STAHL_1973: Source = Source {
    key: "iwan1973",
    reference: "W. D. Iwan, K. J. Stahl: The response of an elastic disk with a moving mass system. \
                Journal of Applied Mechanics 40(2), 445–451, 1973",
};
/// A disc under such a load with friction as a follower force.
pub const CHAN_1994: Source = Source {
    key: "chan1994",
    reference: "S. N. Chan, J. E. Mottershead, M. P. Cartmell: Parametric resonances at subcritical \
                speeds in discs with rotating frictional loads. Proceedings of the Institution of \
                Mechanical Engineers, Part C 208(6), 417–425, 1994",
};
/// The method of multiple scales, and parametric excitation.
pub const NAYFEH_MOOK_1979: Source = Source {
    key: "nayfeh1979",
    reference: "A. H. Nayfeh, D. T. Mook: Nonlinear Oscillations. Wiley, New York, 1979",
};
/// Fourth-order splitting of exponentials.
pub const TAKAHASHI_IMADA_1984: Source = Source {
    key: "takahashi1984",
    reference: "M. Takahashi, M. Imada: Monte Carlo calculation of quantum systems. II. Higher order \
                correction. Journal of the Physical Society of Japan 53, 3765–3769, 1984",
};
/// Mode coupling in its smallest model: two degrees of freedom and Coulomb friction.
pub const HOFFMANN_2002: Source = Source {
    key: "hoffmann2002",
    reference: "N. Hoffmann, M. Fischer, R. Allgaier, L. Gaul: A minimal model for studying properties of the mode-coupling \
                type instability in friction induced oscillations. Mechanics Research Communications 29(4), 197–205, 2002",
};
/// Extrapolation of Gragg's midpoint steps.
pub const HAIRER_NORSETT_WANNER_1993: Source = Source {
    key: "hairer1993",
    reference: "E. Hairer, S. P. Nørsett, G. Wanner: Solving Ordinary Differential Equations I: Nonstiff Problems. \
                2nd edition, Springer, Berlin, 1993",
};

/// The generator SplitMix64.
pub const STEELE_2014: Source = Source {
    key: "steele2014",
    reference: "G. L. Steele, D. Lea, C. H. Flood: Fast splittable pseudorandom number generators. Proceedings of the 2014 ACM \
                International Conference on Object Oriented Programming Systems Languages & Applications (OOPSLA), 453–472, 2014",
};

/// Every source that can be cited.
pub const SOURCES: &[Source] = &[
    MICHAUX_2005,
    THOMSEN_1999,
    THOMSEN_FIDLIN_2003,
    CUNEFARE_GRAF_2002,
    ARMSTRONG_HELOUVRY_1994,
    CANUDAS_DE_WIT_1995,
    GELB_VANDER_VELDE_1968,
    JORBA_ZOU_2005,
    FILIPPOV_1988,
    HARRIS_1978,
    DAS_SAIKI_SANDER_YORKE_2017,
    MENCK_2013,
    WILSON_1927,
    VOGEL_SKINNER_1965,
    IWAN_STAHL_1973,
    CHAN_1994,
    NAYFEH_MOOK_1979,
    TAKAHASHI_IMADA_1984,
    HOFFMANN_2002,
    HAIRER_NORSETT_WANNER_1993,
    STEELE_2014,
];
