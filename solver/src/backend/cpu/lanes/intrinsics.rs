//! The operations that vectors of all instruction sets implement alike.

use super::BLOCK;

/// A row's lanes must exist before they are read or written through a pointer.
#[inline(always)]
pub fn check(at: usize, width: usize) {
    assert!(at + width <= BLOCK);
}

/// Methods that are nothing but one intrinsic, of vectors of `$width` floats.
macro_rules! memory {
    ($width:literal, $features:literal, $splat:ident, $load:ident, $store:ident) => {
        const WIDTH: usize = $width;
        #[inline(always)]
        fn out_of_line(task: impl Task) {
            #[target_feature(enable = $features)]
            #[inline(never)]
            fn run<S: Lanes>(task: impl Task) {
                task.run::<S>();
            }
            // SAFETY: as of `splat`.
            unsafe { run::<Self>(task) }
        }
        #[inline(always)]
        fn splat(x: f32) -> Self {
            // SAFETY: an intrinsic on values needs only its instruction set, and this type is used after
            // that was found.
            Self(unsafe { $splat(x) })
        }
        #[inline(always)]
        fn load(row: &Row, at: usize) -> Self {
            check(at, $width);
            // SAFETY: the lanes lie inside the row, as just checked; the load may be unaligned.
            Self(unsafe { $load(row.0.as_ptr().add(at)) })
        }
        #[inline(always)]
        fn store(self, row: &mut Row, at: usize) {
            check(at, $width);
            // SAFETY: the lanes lie inside the row, as just checked; the store may be unaligned.
            unsafe { $store(row.0.as_mut_ptr().add(at), self.0) }
        }
    };
}

/// Methods of values.
macro_rules! values {
    ($($name:ident($($arg:ident),*) = $body:expr;)*) => {
        $(values!(@ $name, ($($arg),*), $body);)*
    };
    (@ $name:ident, ($a:ident), $body:expr) => {
        // SAFETY: as of `splat`.
        #[inline(always)] fn $name(self) -> Self { let $a = self.0; Self(unsafe { $body }) }
    };
    (@ $name:ident, ($a:ident, $b:ident), $body:expr) => {
        // SAFETY: as of `splat`.
        #[inline(always)] fn $name(self, b: Self) -> Self { let ($a, $b) = (self.0, b.0); Self(unsafe { $body }) }
    };
    (@ $name:ident, ($a:ident, $b:ident, $c:ident, $d:ident), $body:expr) => {
        #[inline(always)]
        fn $name(self, b: Self, c: Self, d: Self) -> Self {
            let ($a, $b, $c, $d) = (self.0, b.0, c.0, d.0);
            // SAFETY: as of `splat`.
            Self(unsafe { $body })
        }
    };
    (@ $name:ident, ($a:ident, $b:ident, $c:ident), $body:expr) => {
        // SAFETY: as of `splat`.
        #[inline(always)] fn $name(self, b: Self, c: Self) -> Self { let ($a, $b, $c) = (self.0, b.0, c.0); Self(unsafe { $body }) }
    };
}

pub(super) use {memory, values};
