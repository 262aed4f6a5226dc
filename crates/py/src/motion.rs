//! Curves that move: step by step, exactly, and what their parameters say before.

use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, PoisonError};

use ndarray::Array3;
use numpy::{IntoPyArray, PyArray3, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use snakes::elastic::{End, Material, Topology};
use snakes::integrator::{Scheme, State};
use snakes::snake::{Body, Certificate, Edit, Snake, Stepping, Until, World};

use crate::errors::value;
use crate::points::{array, points};
use crate::waiting::attended;

/// A simulation between two steps.
#[pyclass(frozen, module = "pysnakes._core")]
pub(crate) struct Simulation(Arc<Mutex<snakes::Simulation>>);

impl Simulation {
    pub(crate) fn of(simulation: snakes::Simulation) -> Self {
        Self(Arc::new(Mutex::new(simulation)))
    }

    fn with<T>(&self, see: impl FnOnce(&mut snakes::Simulation) -> T) -> T {
        see(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

#[pymethods]
impl Simulation {
    /// Make so many steps: how it has ended, if it has, as a word and a sentence.
    fn step(&self, py: Python<'_>, steps: u64) -> PyResult<Option<(&'static str, String)>> {
        let shared = Arc::clone(&self.0);
        let outcome = attended(py, move |stop| {
            let mut simulation = shared.lock().unwrap_or_else(PoisonError::into_inner);
            let run = simulation.start(&Until::steps(u64::MAX));
            simulation.go_on(&run, steps, &mut |_| {
                if stop.load(std::sync::atomic::Ordering::Relaxed) {
                    return ControlFlow::Break(());
                }
                ControlFlow::Continue(())
            })
        })?;
        let outcome = outcome.map_err(value)?;
        Ok(outcome.map(|outcome| (outcome.name(), outcome.to_string())))
    }

    /// Time.
    #[getter]
    fn t(&self) -> f64 {
        self.with(|simulation| simulation.t())
    }

    /// Steps made.
    #[getter]
    fn steps(&self) -> u64 {
        self.with(|simulation| simulation.steps())
    }

    /// Of each curve: its number, whether it is closed, its nodes and their velocities.
    fn curves<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        self.with(|simulation| {
            for member in simulation.members() {
                let state = member.state();
                list.append((
                    member.id(),
                    member.is_closed(),
                    array(py, &state.x),
                    array(py, &state.v),
                ))?;
            }
            Ok(list)
        })
    }

    /// The energies by name.
    fn energies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let out = PyDict::new(py);
        self.with(|simulation| {
            let energies = simulation.energies();
            let orders = simulation.orders();
            let names =
                snakes::snake::Energies::names_with(orders, snakes::Simulation::FORCES.into_iter());
            for (name, number) in names.into_iter().zip(energies.values()) {
                out.set_item(name, number)?;
            }
            out.set_item("total", energies.total())
        })?;
        Ok(out)
    }

    /// Hold nodes of a curve where they are, or let them go.
    fn hold(&self, curve: usize, nodes: Vec<usize>, held: bool) -> PyResult<()> {
        let edit = if held {
            Edit::Hold(nodes)
        } else {
            Edit::Release(nodes)
        };
        self.with(|simulation| simulation.edit(curve, edit))
            .map_err(value)
    }

    /// The same simulation, to be gone on with by itself.
    fn copy(&self) -> Self {
        Self::of(self.with(|simulation| simulation.clone()))
    }
}

/// A lone curve without a world. `numbers`: tether, tension, rigidity, mass, damping.
fn alone(rest: &[snakes::Point], closed: bool, numbers: [f64; 5]) -> PyResult<Snake> {
    let [tether, tension, rigidity, mass, damping] = numbers;
    let topology = if closed {
        Topology::Closed
    } else {
        Topology::open(End::Free)
    };
    let body = Body::of(rest, topology, mass)
        .map_err(value)?
        .with_material(Material::uniform(tether, tension, rigidity))
        .with_damping(damping);
    Snake::new(body, World::default()).map_err(value)
}

/// Places of the nodes at each time, by the exact motion of every mode: a step from the start to each.
#[pyfunction]
pub(crate) fn ring<'py>(
    py: Python<'py>,
    rest: PyReadonlyArray2<'py, f64>,
    start: PyReadonlyArray2<'py, f64>,
    velocity: PyReadonlyArray2<'py, f64>,
    times: Vec<f64>,
    numbers: [f64; 5],
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let snake = alone(&points(&rest)?, true, numbers)?;
    let begun = State {
        v: points(&velocity)?,
        ..State::at_rest(points(&start)?)
    };
    let places = attended(py, move |_| {
        let mut places = Array3::zeros((times.len(), begun.x.len(), 2));
        for (index, t) in times.into_iter().enumerate() {
            let mut at = begun.x.clone();
            if t > 0.0 {
                let stepping = Stepping::of(Scheme::Exact, t);
                let mut motion = snakes::Simulation::of(snake.clone(), begun.clone(), stepping)
                    .map_err(value)?;
                let _ = motion.step().map_err(value)?;
                at.clone_from(&motion.members()[0].state().x);
            }
            for (node, place) in at.iter().enumerate() {
                places[[index, node, 0]] = place.x;
                places[[index, node, 1]] = place.y;
            }
        }
        Ok::<_, PyErr>(places)
    })??;
    Ok(places.into_pyarray(py))
}

/// What a snake's parameters say of its motion.
pub(crate) fn certified<'py>(
    py: Python<'py>,
    certificate: &Certificate,
) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    out.set_item("nodes", certificate.nodes)?;
    out.set_item("elastic", certificate.elastic)?;
    out.set_item("image", certificate.image)?;
    out.set_item("contact", certificate.contact)?;
    let steps = PyDict::new(py);
    for (scheme, limit) in &certificate.steps {
        steps.set_item(scheme.name(), *limit)?;
    }
    out.set_item("step_limits", steps)?;
    let modes = &certificate.modes;
    let column = |of: fn(&snakes::snake::ModeOfMotion) -> f64| {
        let column: Vec<f64> = modes.iter().map(of).collect();
        column.into_pyarray(py)
    };
    out.set_item("frequency", column(|mode| mode.frequency))?;
    out.set_item(
        "damping_ratio",
        column(snakes::snake::ModeOfMotion::damping_ratio),
    )?;
    out.set_item("decay", column(snakes::snake::ModeOfMotion::decay))?;
    out.set_item("time_to_rest", certificate.time_to_rest())?;
    out.set_item("complete", certificate.complete)?;
    out.set_item("text", certificate.to_string())?;
    Ok(out)
}

/// The same of a lone curve. `numbers`: tether, tension, rigidity, mass, damping.
#[pyfunction]
pub(crate) fn certificate<'py>(
    py: Python<'py>,
    rest: PyReadonlyArray2<'py, f64>,
    closed: bool,
    numbers: [f64; 5],
) -> PyResult<Bound<'py, PyDict>> {
    let snake = alone(&points(&rest)?, closed, numbers)?;
    let found = attended(py, move |_| Certificate::of(&snake, None))?;
    certified(py, &found)
}
