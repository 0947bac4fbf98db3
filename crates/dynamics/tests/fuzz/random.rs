//! Numbers from a seed: SplitMix64 (Steele, Lea and Flood 2014), the same on every platform and for ever.

use nalgebra::{Quaternion, Vector3};

/// A stream of numbers.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Of `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Of `low..=high`.
    pub fn whole(&mut self, low: usize, high: usize) -> usize {
        low + (self.bits() % (high - low + 1) as u64) as usize
    }

    pub fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    /// `10^x` with `x` of `[low, high)`.
    pub fn decades(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.between(low, high))
    }

    pub fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.whole(0, choices.len() - 1)]
    }

    /// In the cube `[-1, 1)³`.
    pub fn in_cube(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.between(-1.0, 1.0))
    }

    /// Of length one.
    pub fn direction(&mut self) -> Vector3<f64> {
        loop {
            let v = self.in_cube();
            let length = v.norm();
            if (0.1..=1.0).contains(&length) {
                return v / length;
            }
        }
    }

    /// Any orientation.
    pub fn orientation(&mut self) -> Quaternion<f64> {
        loop {
            let q = Quaternion::from(nalgebra::Vector4::from_fn(|_, _| self.between(-1.0, 1.0)));
            if (0.1..=1.0).contains(&q.norm()) {
                return q / q.norm();
            }
        }
    }
}
