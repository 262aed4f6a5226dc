//! The text of further snakes, of what happens where they meet, and of how curves are kept in order.

use serde::Deserialize;

use super::{DensitiesText, ForceText, MaterialText, ShapeText, TopologyText};

/// Further snakes: as the first, but for what is given here.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct AlsoText {
    /// One snake for each place: its center there.
    pub at: Option<Vec<[f64; 2]>>,
    pub nodes: Option<usize>,
    pub topology: Option<TopologyText>,
    pub start: Option<ShapeText>,
    pub rest: Option<ShapeText>,
    pub velocity: Option<[f64; 2]>,
    pub spin: Option<f64>,
    pub material: Option<MaterialText>,
    pub densities: Option<DensitiesText>,
    #[serde(default, deserialize_with = "super::force::own_forces")]
    pub force: Option<Vec<ForceText>>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct ContactText {
    pub stiffness: f64,
    #[serde(default)]
    pub damping: f64,
    #[serde(default)]
    pub friction: f64,
    #[serde(default)]
    pub wall_friction: f64,
    #[serde(default = "whole")]
    pub stick: f64,
    #[serde(default)]
    pub adhesion: f64,
    #[serde(default)]
    pub range: f64,
    #[serde(default)]
    pub gap: f64,
    pub stop: f64,
    #[serde(default)]
    pub own: bool,
}

fn whole() -> f64 {
    1.0
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct UpkeepText {
    #[serde(default = "ten")]
    pub every: u64,
    pub stretch: Option<f64>,
    pub least_area: Option<f64>,
    pub merge: Option<f64>,
    pub plastic: Option<PlasticText>,
    #[serde(default)]
    pub growth: f64,
}

fn ten() -> u64 {
    10
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct PlasticText {
    pub yields_at: f64,
    pub rate: f64,
}
