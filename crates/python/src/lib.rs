//! `tumblers._core`: conversions and forwarding.

mod body;
mod convert;
#[allow(non_snake_case)] // keywords carry their SI units, and T and Hz have capitals
mod field;
mod run;
mod sensing;
mod step;
#[allow(non_snake_case)]
mod trial;
mod walk;

use pyo3::prelude::*;

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<body::PyBody>()?;
    module.add_class::<field::PyField>()?;
    module.add_class::<trial::PyTrial>()?;
    module.add_function(wrap_pyfunction!(run::simulate, module)?)?;
    module.add_function(wrap_pyfunction!(run::sweep, module)?)?;
    module.add_function(wrap_pyfunction!(run::rollouts, module)?)?;
    module.add_class::<walk::PyWalk>()?;
    module.add_class::<sensing::PyMeasured>()?;
    module.add_function(wrap_pyfunction!(sensing::compare, module)?)?;
    module.add("HUBER", ::sensing::HUBER)?;
    module.add("FAR", ::sensing::FAR)?;
    module.add("END_ROWS", ::sensing::END_ROWS)?;
    module.add("CLOCK_STEP_S", ::sensing::CLOCK_STEP)?;
    module.add_function(wrap_pyfunction!(step::step, module)?)?;
    Ok(())
}
