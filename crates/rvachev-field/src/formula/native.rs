//! Native code for formulas, by fidget.
//!
//! To compile costs about as much as to interpret some thousands of points, so a formula is
//! interpreted until it was asked for that many. Most of the formulas that narrowing makes
//! never are. Every piece of native code is a mapping of memory, of which a process has some
//! ten thousands: only so many are alive at a time.

#[cfg(feature = "jit")]
pub(super) use jit::Native;

#[cfg(feature = "jit")]
mod jit {
    use std::cell::RefCell;
    use std::sync::OnceLock;
    use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

    use fidget::context::Context;
    use fidget::eval::{BulkEvaluator, Function, MathFunction, Tape};
    use fidget::jit::JitFunction;
    use fidget::var::Var;

    use super::super::code::Code;

    type Evaluator = <JitFunction as Function>::FloatSliceEval;
    type Machine = <Evaluator as BulkEvaluator>::Tape;

    /// After so many points the rest are worth compiling for.
    const POINTS: u64 = 8192;

    /// So many pieces of native code are alive at a time, at most.
    const MOST: usize = 256;

    static ALIVE: AtomicUsize = AtomicUsize::new(0);

    thread_local! {
        static EVALUATOR: RefCell<Evaluator> = RefCell::new(Evaluator::default());
    }

    /// The native code of a formula, if and when it has some.
    #[derive(Default)]
    pub(in super::super) struct Native {
        points: AtomicU64,
        compiled: OnceLock<Option<Compiled>>,
    }

    struct Compiled {
        machine: Machine,
        /// Which axis each of its inputs is.
        inputs: Vec<usize>,
    }

    impl Drop for Compiled {
        fn drop(&mut self) {
            ALIVE.fetch_sub(1, Ordering::Relaxed);
        }
    }

    impl Native {
        /// Runs the native code over slices of one length; whether there is any.
        pub(in super::super) fn run(&self, code: &Code, points: [&[f32]; 3], out: &mut [f32]) -> bool {
            let compiled = match self.compiled.get() {
                Some(compiled) => compiled,
                None if self.points.fetch_add(out.len() as u64, Ordering::Relaxed) < POINTS => return false,
                None => self.compiled.get_or_init(|| compile(code)),
            };
            let Some(compiled) = compiled else { return false };
            EVALUATOR.with_borrow_mut(|evaluator| {
                let mut inputs = [points[0]; 3];
                for (input, axis) in inputs.iter_mut().zip(&compiled.inputs) {
                    *input = points[*axis];
                }
                match evaluator.eval(&compiled.machine, &inputs[..compiled.inputs.len()]) {
                    Ok(values) => {
                        out.copy_from_slice(&values[0]);
                        true
                    }
                    Err(_) => false,
                }
            })
        }
    }

    /// Whether this processor has the instructions that fidget writes; fidget does not ask.
    #[cfg(target_arch = "x86_64")]
    fn runs_here() -> bool {
        std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn runs_here() -> bool {
        true
    }

    fn compile(code: &Code) -> Option<Compiled> {
        if !(code.is_elementary() && runs_here()) {
            return None;
        }
        if ALIVE.fetch_add(1, Ordering::Relaxed) >= MOST {
            ALIVE.fetch_sub(1, Ordering::Relaxed);
            return None;
        }
        let compiled = machine(code);
        if compiled.is_none() {
            ALIVE.fetch_sub(1, Ordering::Relaxed);
        }
        compiled
    }

    fn machine(code: &Code) -> Option<Compiled> {
        let mut context = Context::new();
        let root = context.import(&code.tree());
        let machine = JitFunction::new(&context, &[root]).ok()?.float_slice_tape(Default::default());
        let mut inputs = vec![None; machine.vars().len()];
        for (axis, var) in [Var::X, Var::Y, Var::Z].into_iter().enumerate() {
            if let Some(slot) = machine.vars().get(&var).and_then(|at| inputs.get_mut(at)) {
                *slot = Some(axis);
            }
        }
        // A constant has no inputs to count the points by.
        let inputs: Option<Vec<usize>> = inputs.into_iter().collect();
        inputs.filter(|inputs| !inputs.is_empty()).map(|inputs| Compiled { machine, inputs })
    }
}

#[cfg(not(feature = "jit"))]
#[derive(Default)]
pub(super) struct Native {}

#[cfg(not(feature = "jit"))]
impl Native {
    pub(super) fn run(&self, _code: &super::code::Code, _points: [&[f32]; 3], _out: &mut [f32]) -> bool {
        false
    }
}
