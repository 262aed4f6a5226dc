//! The text of further snakes, of what happens where they meet, and of how curves are kept in order.

use serde::{Deserialize, Serialize};

use super::{
    DensitiesText, ForceText, MaterialText, NodesText, ShapeText, TopologyText, is, usual,
};

/// Further snakes: as the first, but for what is given here.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct AlsoText {
    /// One snake for each place: its center there.
    pub at: Option<Vec<[f64; 2]>>,
    pub nodes: Option<NodesText>,
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

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct ContactText {
    pub stiffness: f64,
    #[serde(default, skip_serializing_if = "usual")]
    pub damping: f64,
    #[serde(default, skip_serializing_if = "usual")]
    pub friction: f64,
    #[serde(default, skip_serializing_if = "usual")]
    pub wall_friction: f64,
    #[serde(default = "whole", skip_serializing_if = "is_whole")]
    pub stick: f64,
    #[serde(default, skip_serializing_if = "usual")]
    pub adhesion: f64,
    #[serde(default, skip_serializing_if = "usual")]
    pub range: f64,
    #[serde(default, skip_serializing_if = "usual")]
    pub gap: f64,
    pub stop: f64,
    #[serde(default, skip_serializing_if = "usual")]
    pub own: bool,
}

fn whole() -> f64 {
    1.0
}

fn is_whole(value: &f64) -> bool {
    is(*value, whole())
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct UpkeepText {
    #[serde(default = "ten", skip_serializing_if = "is_ten")]
    pub every: u64,
    pub stretch: Option<f64>,
    pub least_area: Option<f64>,
    pub merge: Option<f64>,
    pub plastic: Option<PlasticText>,
    #[serde(default, skip_serializing_if = "usual")]
    pub growth: f64,
}

fn ten() -> u64 {
    10
}

fn is_ten(value: &u64) -> bool {
    *value == ten()
}

#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct PlasticText {
    pub yields_at: f64,
    pub rate: f64,
}
