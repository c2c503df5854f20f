//! The coordinate system that a plan names: `crs` of GeoJSON before RFC 7946, `SRID` of extended well-known text.

use geojson::{GeoJson, JsonValue};

/// Systems in degrees: CRS84 and the EPSG codes of WGS 84, ETRS89 and NAD83.
const IN_DEGREES: [&str; 6] = ["CRS84", "CRS84h", "4326", "4979", "4258", "4269"];
/// Web Mercator: EPSG code, and the older name of it.
const WEB_MERCATOR: [&str; 2] = ["3857", "900913"];
/// How to mend a plan in degrees.
pub(crate) const PROJECT_IT: &str = "project it to metres, for instance to the UTM zone of the place";
/// Greatest number of letters that a message shows of a name.
const SHOWN: usize = 80;

/// A coordinate system by its name.
pub(crate) struct CoordinateSystem {
    /// Its name as the file states it.
    pub(crate) name: String,
    /// Whether its coordinates are degrees.
    pub(crate) is_in_degrees: bool,
    /// What a note adds where lengths are not true; empty elsewhere.
    pub(crate) stretch: &'static str,
}

impl CoordinateSystem {
    /// The system that a file names; none where it names none.
    pub(crate) fn of(json: &GeoJson) -> Option<Self> {
        let members = match json {
            GeoJson::Geometry(geometry) => geometry.foreign_members.as_ref(),
            GeoJson::Feature(feature) => feature.foreign_members.as_ref(),
            GeoJson::FeatureCollection(all) => all.foreign_members.as_ref(),
        };
        let crs = members?.get("crs").filter(|crs| !crs.is_null())?;
        let property = |key: &str| match crs.get("properties")?.get(key)? {
            JsonValue::String(name) => Some(name.clone()),
            JsonValue::Number(code) => Some(code.to_string()),
            _ => None,
        };
        let name: String =
            property("name").or_else(|| property("code")).unwrap_or_else(|| "a system without name".to_owned());
        Some(Self::of_name(&name))
    }

    /// The system of a name.
    pub(crate) fn of_name(name: &str) -> Self {
        // `urn:ogc:def:crs:EPSG::4326`, `EPSG:4326`, `http://…/CRS84`, `http://…/epsg.xml#4326`.
        let code = name.rsplit([':', '/', '#']).next().unwrap_or_default().trim();
        let is_any_of = |codes: &[&str]| codes.iter().any(|other| code.eq_ignore_ascii_case(other));
        let stretch = match is_any_of(&WEB_MERCATOR) {
            true => "; this projection stretches lengths away from the equator",
            false => "",
        };
        Self { is_in_degrees: is_any_of(&IN_DEGREES), stretch, name: name.chars().take(SHOWN).collect() }
    }
}
