//! The table of all experiments, in the order of the report.

use crate::Experiment;
use crate::experiments::{
    angle, apple, atlas, ball, balloon, corners, curvature, damping, damping_rules, decomposition,
    disc, drawn_frames, ends, energy, followed, force_field, forces, maps, matrix, open_curves,
    orders, profiles, rest_traps, signal, smoothing, soft, time_step, turned_picture, turning,
};

/// Every experiment. A new one is added here and nowhere else.
pub const EXPERIMENTS: &[&Experiment] = &[
    &followed::FOLLOWED,
    &decomposition::DECOMPOSITION,
    &energy::ENERGY,
    &orders::ORDERS,
    &ball::VERY_SOFT,
    &ball::SOFT,
    &ball::RIGID,
    &ball::HARD,
    &ball::VERY_HARD,
    &ball::OVERVIEW,
    &ball::WALLS,
    &ball::FRICTION,
    &matrix::MATRIX,
    &ends::ENDS_OF_A_STRIP,
    &corners::CORNERS,
    &profiles::PROFILES,
    &maps::MAPS,
    &damping::DAMPING,
    &damping_rules::RULES_OF_DAMPING,
    &time_step::TIME_STEP,
    &smoothing::SMOOTHING,
    &signal::STEP,
    &signal::BOX,
    &signal::FORCE,
    &disc::DISC,
    &force_field::FIELD,
    &forces::FIELDS,
    &forces::BARS,
    &forces::ROTATION,
    &forces::CAPTURE,
    &forces::FITTED,
    &forces::NOISE,
    &apple::FIRST,
    &apple::SECOND,
    &apple::THIRD,
    &apple::OVERVIEW,
    &apple::DRAWN,
    &apple::RULES,
    &apple::CLOSED,
    &angle::ANGLE,
    &atlas::FAMILY,
    &atlas::MASS,
    &atlas::STIFFNESS,
    &atlas::STEP,
    &soft::PILE,
    &soft::GAS,
    &soft::ROPE,
    &soft::FUNNEL,
    &soft::DENT,
    &soft::SLOPE,
    &soft::CELLS,
    &soft::RESPACING,
    &soft::FATES,
    &soft::GROWTH,
    &soft::LEDGER,
    &rest_traps::REST,
    &curvature::CURVATURE,
    &turning::TURNING,
    &turned_picture::PICTURE,
    &drawn_frames::FRAMES_DRAWN,
    &balloon::BALLOON,
    &open_curves::OPEN_CURVES,
    &apple::HAND,
];

/// The experiment of that name.
#[must_use]
pub fn find(id: &str) -> Option<&'static Experiment> {
    EXPERIMENTS
        .iter()
        .copied()
        .find(|experiment| experiment.id == id)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_experiment_has_an_id_of_its_own_and_claims_something() {
        for (index, experiment) in EXPERIMENTS.iter().enumerate() {
            let twin = EXPERIMENTS[..index]
                .iter()
                .any(|other| other.id == experiment.id);
            assert!(!twin, "{} twice", experiment.id);
            assert!(
                !experiment.claims.is_empty(),
                "{} claims nothing",
                experiment.id
            );
            let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
            assert!(
                experiment.id.chars().all(plain),
                "{} is no file name",
                experiment.id
            );
        }
    }
}
