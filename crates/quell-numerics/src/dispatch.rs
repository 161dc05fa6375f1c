//! Run-time dispatch to the best instruction set of the machine, with the same bits on all of them.
//!
//! The baseline build calls a library routine for each fused multiply-add and has no wide
//! vectors. Work passed to this module is compiled once per instruction set and runs in
//! the best version that the processor supports. Every operation of a [`Lane`] is correctly rounded
//! in each version, so that the bits of the result do not depend on the instruction set.
//!
//! The lane types of AVX2 and AVX-512 are private to this file: code is generic over
//! [`Lane`] and is instantiated with them only in a version compiled for their instructions.

#[cfg(target_arch = "x86_64")]
use std::ops::{Add, Mul, Neg, Sub};

use crate::lane::Lane;
#[cfg(target_arch = "x86_64")]
use crate::lane::LanePair;

/// Work compiled per instruction set. `run` and everything it calls in a hot loop must be
/// `#[inline(always)]`, otherwise they stay in the baseline version.
pub trait Work {
    /// Result of the work.
    type Output;
    /// Does the work.
    fn run(self) -> Self::Output;
}

/// Work on as many lanes as the machine supports, compiled per instruction set like [`Work`].
pub trait LaneWork {
    /// Result of the work.
    type Output;
    /// Does the work in lanes of type `V`.
    fn run<V: Lane>(self) -> Self::Output;
}

/// Instruction sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InstructionSet {
    /// One number at a time, without hardware fused multiply-add: runs on every machine.
    Baseline,
    /// One number at a time, with fused multiply-add (x86-64-v3): the fastest for a single run.
    Fma,
    /// AVX2 with FMA (x86-64-v3): 2 × 4 lanes.
    Avx2,
    /// AVX-512 (x86-64-v4): 2 × 8 lanes.
    Avx512,
}

impl InstructionSet {
    /// All instruction sets, the widest first.
    pub const ALL: [Self; 4] = [Self::Avx512, Self::Avx2, Self::Fma, Self::Baseline];

    /// The widest one that this machine supports.
    pub fn widest() -> Self {
        Self::ALL.into_iter().find(|set| set.is_available()).unwrap_or(Self::Baseline)
    }

    /// Whether this machine supports it.
    pub fn is_available(self) -> bool {
        match self {
            Self::Baseline => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 | Self::Fma => pulp::x86::V3::try_new().is_some(),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => pulp::x86::V4::try_new().is_some(),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Fma | Self::Avx2 | Self::Avx512 => false,
        }
    }

    /// Name for output.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Fma => "FMA",
            Self::Avx2 => "AVX2",
            Self::Avx512 => "AVX-512",
        }
    }
}

struct Vectorized<W>(W);

impl<W: Work> pulp::NullaryFnOnce for Vectorized<W> {
    type Output = W::Output;

    #[inline(always)]
    fn call(self) -> W::Output {
        self.0.run()
    }
}

/// Runs `work` with the best instructions for scalar code.
#[inline]
pub fn with_fused_multiply_add<W: Work>(work: W) -> W::Output {
    with_scalar_of(InstructionSet::Fma, work)
}

/// Runs `work` if the machine supports fused multiply-add, else gives it back: for code with a slower form of the same bits, which
/// is then the only one compiled for the baseline.
///
/// # Errors
/// The work, on a machine without fused multiply-add.
#[inline]
pub fn only_with_fused_multiply_add<W: Work>(work: W) -> Result<W::Output, W> {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return Ok(simd.vectorize(Vectorized(work)));
    }
    Err(work)
}

/// Runs `work` with the scalar instructions that correspond to the lanes of `set`: those of the baseline, or
/// fused multiply-add if the machine supports it.
#[inline]
pub fn with_scalar_of<W: Work>(set: InstructionSet, work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if set != InstructionSet::Baseline
        && let Some(simd) = pulp::x86::V3::try_new()
    {
        return simd.vectorize(Vectorized(work));
    }
    let _ = set;
    pulp::NullaryFnOnce::call(Vectorized(work))
}

/// [`LaneWork`] in lanes of `V`, as [`Work`].
#[cfg(target_arch = "x86_64")]
struct InLanes<W, V>(W, std::marker::PhantomData<V>);

#[cfg(target_arch = "x86_64")]
impl<W: LaneWork, V: Lane> pulp::NullaryFnOnce for InLanes<W, V> {
    type Output = W::Output;

    #[inline(always)]
    fn call(self) -> W::Output {
        self.0.run::<V>()
    }
}

/// Runs `work` in lanes of `set`, or of the widest supported set if the machine does not support `set`.
pub fn with_lanes<W: LaneWork>(set: InstructionSet, work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    {
        if set == InstructionSet::Avx512
            && let Some(simd) = pulp::x86::V4::try_new()
        {
            return simd.vectorize(InLanes::<W, LanePair<Eight>>(work, std::marker::PhantomData));
        }
        if set != InstructionSet::Baseline
            && let Some(simd) = pulp::x86::V3::try_new()
        {
            return if set == InstructionSet::Fma {
                simd.vectorize(InLanes::<W, f64>(work, std::marker::PhantomData))
            } else {
                simd.vectorize(InLanes::<W, LanePair<Four>>(work, std::marker::PhantomData))
            };
        }
    }
    let _ = set;
    work.run::<f64>()
}

/// Runs `work` in four lanes if the machine supports them, else gives it back: for numbers of one run side by side, whose code has
/// another form with the same bits.
///
/// # Errors
/// The work, on a machine without AVX2.
#[inline]
pub fn only_in_four_lanes<W: LaneWork>(work: W) -> Result<W::Output, W> {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return Ok(simd.vectorize(InLanes::<W, Four>(work, std::marker::PhantomData)));
    }
    Err(work)
}

/// Implements [`Lane`] for a vector of pulp.
#[cfg(target_arch = "x86_64")]
macro_rules! vector_lane {
    ($(#[$about:meta])* $name:ident, $vector:ident, $lanes:literal, $token:ident) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug)]
        struct $name(pulp::$vector);

        impl $name {
            /// Proof that the instructions are available.
            #[inline(always)]
            #[expect(unsafe_code, reason = "the type is private and only used inside `vectorize`")]
            fn token() -> pulp::x86::$token {
                // SAFETY: the type cannot be named outside this file, and in this file
                // only `with_lanes` and `only_in_four_lanes` pass it to work, inside
                // `vectorize` of a token that `try_new` has checked.
                unsafe { pulp::x86::$token::new_unchecked() }
            }

            #[inline(always)]
            fn lanes(self) -> [f64; $lanes] {
                pulp::cast(self.0)
            }

            #[inline(always)]
            fn of(lanes: [f64; $lanes]) -> Self {
                Self(pulp::cast(lanes))
            }
        }

        impl Add for $name {
            type Output = Self;

            #[inline(always)]
            fn add(self, other: Self) -> Self {
                Self(pulp::Simd::add_f64s(Self::token(), self.0, other.0))
            }
        }

        impl Sub for $name {
            type Output = Self;

            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                Self(pulp::Simd::sub_f64s(Self::token(), self.0, other.0))
            }
        }

        impl Mul for $name {
            type Output = Self;

            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                Self(pulp::Simd::mul_f64s(Self::token(), self.0, other.0))
            }
        }

        impl Neg for $name {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                Self(pulp::Simd::neg_f64s(Self::token(), self.0))
            }
        }

        impl Lane for $name {
            const LANES: usize = $lanes;

            #[inline(always)]
            fn splat(value: f64) -> Self {
                Self(pulp::Simd::splat_f64s(Self::token(), value))
            }

            #[inline(always)]
            fn load(from: &[f64]) -> Self {
                let mut lanes = [0.0; $lanes];
                lanes.copy_from_slice(&from[..$lanes]);
                Self::of(lanes)
            }

            #[inline(always)]
            fn store(self, to: &mut [f64]) {
                to[..$lanes].copy_from_slice(&self.lanes());
            }

            #[inline(always)]
            fn lane(&self, lane: usize) -> f64 {
                pulp::bytemuck::cast_ref::<_, [f64; $lanes]>(&self.0)[lane]
            }

            #[inline(always)]
            fn set_lane(&mut self, lane: usize, value: f64) {
                pulp::bytemuck::cast_mut::<_, [f64; $lanes]>(&mut self.0)[lane] = value;
            }

            #[inline(always)]
            fn pairwise(self, place: usize) -> Self {
                let mut lanes = self.lanes();
                for pair in 0..$lanes / 2 {
                    let number = lanes[2 * pair + place];
                    (lanes[2 * pair], lanes[2 * pair + 1]) = (number, number);
                }
                Self::of(lanes)
            }

            #[inline(always)]
            fn map(self, function: impl Fn(f64) -> f64) -> Self {
                // A loop, because an iterator of the standard library may not be inlined and would then
                // be compiled without the instructions of this lane.
                let mut lanes = self.lanes();
                for lane in &mut lanes {
                    *lane = function(*lane);
                }
                Self::of(lanes)
            }

            #[inline(always)]
            fn zip(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
                let (mut lanes, other) = (self.lanes(), other.lanes());
                for lane in 0..$lanes {
                    lanes[lane] = function(lanes[lane], other[lane]);
                }
                Self::of(lanes)
            }

            #[inline(always)]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                Self(pulp::Simd::mul_add_e_f64s(Self::token(), self.0, factor.0, addend.0))
            }

            #[inline(always)]
            fn abs(self) -> Self {
                // The bits without the sign; the vector of them is a constant, which `abs_f64s` computes by a call.
                let rest = pulp::Simd::splat_f64s(Self::token(), f64::from_bits(!(1 << 63)));
                Self(pulp::Simd::and_f64s(Self::token(), self.0, rest))
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                Self(pulp::Simd::max_f64s(Self::token(), self.0, other.0))
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                Self(pulp::Simd::min_f64s(Self::token(), self.0, other.0))
            }

            #[inline(always)]
            fn where_positive(self, yes: Self, no: Self) -> Self {
                let zero = pulp::Simd::splat_f64s(Self::token(), 0.0);
                let mask = pulp::Simd::greater_than_f64s(Self::token(), self.0, zero);
                Self(pulp::Simd::select_f64s(Self::token(), mask, yes.0, no.0))
            }

            #[inline(always)]
            fn any_positive(self) -> bool {
                let zero = pulp::Simd::splat_f64s(Self::token(), 0.0);
                let mask = pulp::Simd::greater_than_f64s(Self::token(), self.0, zero);
                pulp::Simd::first_true_m64s(Self::token(), mask) < $lanes
            }
        }
    };
}

#[cfg(target_arch = "x86_64")]
vector_lane!(
    /// Four lanes of AVX2.
    Four, f64x4, 4, V3
);
#[cfg(target_arch = "x86_64")]
vector_lane!(
    /// Eight lanes of AVX-512.
    Eight, f64x8, 8, V4
);

#[cfg(test)]
mod tests {
    use super::*;

    const LANES: usize = 16;

    /// Every operation on the same numbers, lane by lane.
    struct Operations<'a>(&'a [f64; LANES], &'a [f64; LANES]);

    impl LaneWork for Operations<'_> {
        type Output = Vec<u64>;

        #[inline(always)]
        fn run<V: Lane>(self) -> Vec<u64> {
            let mut bits = vec![0; 17 * LANES];
            let mut first = 0;
            while first < LANES {
                let (a, b) = (V::load(&self.0[first..]), V::load(&self.1[first..]));
                let results = [
                    a + b,
                    a - b,
                    a * b,
                    -a,
                    a.mul_add(b, V::splat(0.3)),
                    a.abs(),
                    a.max(b),
                    a.min(b),
                    b.max(a),
                    b.min(a),
                    a.where_positive(b, V::splat(7.0)),
                    a.round(),
                    a.round().power_of_two(),
                    a.abs().map(f64::sqrt),
                    a.zip(b, |a, b| a / b),
                    crate::elementary::exp(a),
                    crate::elementary::sin_cos_of_phase(a, b, V::splat(1e-17), V::splat(0.2)).0,
                ];
                for (row, result) in results.into_iter().enumerate() {
                    let mut lanes = [0.0; LANES];
                    result.store(&mut lanes);
                    for (lane, value) in lanes.into_iter().enumerate().take(V::LANES) {
                        bits[row * LANES + first + lane] = value.to_bits();
                    }
                }
                first += V::LANES;
            }
            bits
        }
    }

    /// Whether any of sixteen numbers is positive, in groups of lanes.
    struct Any<'a>(&'a [f64; LANES]);

    impl LaneWork for Any<'_> {
        type Output = bool;

        #[inline(always)]
        fn run<V: Lane>(self) -> bool {
            (0..LANES / V::LANES).any(|group| V::load(&self.0[group * V::LANES..]).any_positive())
        }
    }

    /// Replaces one number of sixteen, and reads all of them.
    struct Replaced<'a>(&'a [f64; LANES], usize);

    impl LaneWork for Replaced<'_> {
        type Output = Vec<f64>;

        #[inline(always)]
        fn run<V: Lane>(self) -> Vec<f64> {
            let mut groups: Vec<V> = self.0.chunks(V::LANES).map(V::load).collect();
            groups[self.1 / V::LANES].set_lane(self.1 % V::LANES, 100.0);
            (0..LANES).map(|place| groups[place / V::LANES].lane(place % V::LANES)).collect()
        }
    }

    #[test]
    fn four_lanes_have_the_bits_of_the_baseline() {
        let a = std::array::from_fn(|lane| (lane as f64 - 7.3) * 1.37);
        let b = std::array::from_fn(|lane| 40.0 / (lane as f64 + 0.7));
        match only_in_four_lanes(Operations(&a, &b)) {
            Ok(bits) => assert_eq!(bits, Operations(&a, &b).run::<f64>()),
            Err(_) => assert!(!InstructionSet::Avx2.is_available()),
        }
    }

    #[test]
    fn one_lane_is_read_and_replaced() {
        let numbers = std::array::from_fn(|lane| lane as f64 - 3.0);
        for (set, place) in
            InstructionSet::ALL.into_iter().flat_map(|set| (0..LANES).map(move |p| (set, p)))
        {
            let mut expected = numbers.to_vec();
            expected[place] = 100.0;
            assert_eq!(with_lanes(set, Replaced(&numbers, place)), expected, "{}", set.name());
        }
    }

    /// Pairs of sixteen numbers by their first and by their second lane, where there are pairs.
    struct Pairs<'a>(&'a [f64; LANES]);

    impl LaneWork for Pairs<'_> {
        type Output = (usize, Vec<[f64; 2]>);

        #[inline(always)]
        fn run<V: Lane>(self) -> (usize, Vec<[f64; 2]>) {
            let mut out = Vec::new();
            for first in (0..LANES).step_by(V::LANES) {
                let numbers = V::load(&self.0[first..]);
                let by = [numbers.pairwise(0), numbers.pairwise(1)];
                out.extend((0..V::LANES).map(|lane| by.map(|by| by.lane(lane))));
            }
            (V::LANES, out)
        }
    }

    #[test]
    fn lanes_in_pairs_have_the_number_of_one_of_them() {
        let numbers: [f64; LANES] = std::array::from_fn(|lane| lane as f64);
        for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
            let (lanes, pairs) = with_lanes(set, Pairs(&numbers));
            for (lane, by) in pairs.into_iter().enumerate() {
                let even = (lane - lane % 2) as f64;
                let expected = if lanes == 1 { [lane as f64; 2] } else { [even, even + 1.0] };
                assert_eq!(by, expected, "{}, lane {lane}", set.name());
            }
        }
    }

    #[test]
    fn any_positive_detects_every_lane() {
        for set in InstructionSet::ALL {
            let mut numbers = [-1.0, 0.0, -0.0, f64::NAN].repeat(4);
            for lane in 0..LANES {
                let kept = numbers[lane];
                numbers[lane] = f64::MIN_POSITIVE;
                let lanes: [f64; LANES] = std::array::from_fn(|lane| numbers[lane]);
                assert!(with_lanes(set, Any(&lanes)), "{}, lane {lane}", set.name());
                numbers[lane] = kept;
            }
            let lanes: [f64; LANES] = std::array::from_fn(|lane| numbers[lane]);
            assert!(!with_lanes(set, Any(&lanes)), "{}", set.name());
        }
    }

    #[test]
    fn operations_are_bit_identical_on_all_instruction_sets() {
        let a = std::array::from_fn(|lane| (lane as f64 - 7.3) * 1.37);
        let mut b: [f64; LANES] = std::array::from_fn(|lane| 40.0 / (lane as f64 + 0.7));
        // Equal numbers and zeros of both signs test which operand max and min return.
        (b[3], b[4], b[5]) = (a[3], 0.0, -0.0);
        let alone = Operations(&a, &b).run::<f64>();
        let zeros = ([0.0; LANES], [-0.0; LANES]);
        let zeros_alone = Operations(&zeros.0, &zeros.1).run::<f64>();
        for set in InstructionSet::ALL {
            assert_eq!(with_lanes(set, Operations(&a, &b)), alone, "{}", set.name());
            assert_eq!(with_lanes(set, Operations(&zeros.0, &zeros.1)), zeros_alone);
        }
    }
}
