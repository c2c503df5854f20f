//! What belongs to a scene besides walls and agents is drawn at its place, in its colour.

use fbcrowd_render::plots::crowd::trajectories;
use fbcrowd_render::top_view::{TopView, Tracks};
use fbcrowd_sim::behaviour::{Area, Signal, SignalOrder};
use fbcrowd_sim::population::{Population, SignalChange};
use fbcrowd_sim::recording::Header;
use fbcrowd_sim::route::mesh::WalkablePolygon;
use fbcrowd_sim::scenario::{Marking, MarkingColour, MarkingShape, PlaceLabel, View};
use glam::Vec2;

use crate::support;

/// Bytes of a marking's colour.
const BLUE: [u8; 3] = [40, 60, 220];

fn square(centre_m: Vec2, half_m: f32) -> Vec<Vec2> {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|corner| centre_m + half_m * Vec2::from(corner)).to_vec()
}

/// A zebra crossing whose bars reach from y = 1 to 3, and a lamp that is green from 10 s on for 5 s, at (−3, −3).
pub(crate) fn marked(mut header: Header) -> Header {
    let ends_m = [Vec2::new(-4.0, 2.0), Vec2::new(4.0, 2.0)];
    let zebra = MarkingShape::Line { ends_m, width_m: 2.0, dash_m: Some([1.0, 1.0]) };
    let lamp = MarkingShape::Area(Area::Disc { centre_m: Vec2::splat(-3.0), radius_m: 1.0 });
    header.scenario.markings = vec![
        Marking { shape: zebra, colour: MarkingColour::Fixed(BLUE) },
        Marking { shape: lamp, colour: MarkingColour::Signal(0) },
    ];
    header.scenario.behaviour.signals = vec![Signal { name: "lamp".into(), green_s: 5.0, red_s: 20.0, offset_s: 10.0 }];
    header
}

/// A square hall with a hole in its middle, and what `marked` adds; no obstacles.
fn hall() -> Header {
    let view = View { width: 400, height: 400, centre_m: Some(Vec2::ZERO), width_m: Some(10.0), ..View::default() };
    let mut header = marked(support::circle(1, 0.0, view));
    header.scenario.obstacles_m.clear();
    header.scenario.walkable_m =
        vec![WalkablePolygon { outline_m: square(Vec2::ZERO, 4.5), holes_m: vec![square(Vec2::ZERO, 0.5)] }];
    header
}

/// Colours of the hall at a time, by position, m.
fn colours(header: &Header, time_s: f32) -> impl Fn([f32; 2]) -> [u8; 3] + use<> {
    colours_after(header, &Population::default(), time_s)
}

/// As [`colours`], after what happened to signals.
fn colours_after(header: &Header, population: &Population, time_s: f32) -> impl Fn([f32; 2]) -> [u8; 3] + use<> {
    let tracks = Tracks::new(0.1);
    let top_view = TopView::new(header, &tracks).unwrap().with_doors(population);
    let (framing, picture) = (*top_view.framing(), top_view.draw(&mut top_view.buffers(), time_s, &[]).clone());
    move |at_m| {
        let at_px = framing.to_px(Vec2::from(at_m));
        let pixel = picture.pixel(at_px.x as u32, at_px.y as u32).unwrap();
        [pixel.red(), pixel.green(), pixel.blue()]
    }
}

#[test]
fn bars_and_gaps_of_a_zebra_crossing_take_turns() {
    let colours = colours(&hall(), 0.0);
    let at = |x: f32, y: f32| colours([x, y]);
    assert_eq!([at(-3.5, 2.5), at(-1.5, 1.5), at(2.5, 2.5)], [BLUE; 3]);
    assert!([at(-2.5, 2.5), at(-3.5, 3.3), at(3.4, 2.5)].iter().all(|colour| *colour != BLUE));
}

#[test]
fn ground_that_is_not_walkable_is_darker() {
    let colours = colours(&hall(), 0.0);
    let brightness = |x: f32, y: f32| colours([x, y]).map(u32::from).iter().sum::<u32>();
    let walkable = brightness(2.3, -2.3);
    assert!([brightness(4.8, 0.3), brightness(0.2, 0.2)].iter().all(|outside| outside + 120 < walkable));
}

#[test]
fn a_lamp_changes_with_its_signal() {
    let is_green = |time_s: f32| {
        let [red, green, _] = colours(&hall(), time_s)([-3.0, -3.0]);
        green > red
    };
    assert_eq!([0.0, 9.9, 10.0, 14.9, 15.1, 36.0].map(is_green), [false, false, true, true, false, true]);
}

#[test]
fn a_lamp_shows_what_events_have_ordered() {
    let header = hall();
    let frame = |time_s: f32| (time_s / header.scenario.dt_s).round() as u32;
    let change = |time_s, order| SignalChange { frame: frame(time_s), signal: 0, order };
    let signals =
        vec![change(2.0, SignalOrder::Green), change(12.0, SignalOrder::Red), change(30.0, SignalOrder::Phases)];
    let population = Population { signals, ..Population::default() };
    let is_green = |time_s: f32| {
        let [red, green, _] = colours_after(&header, &population, time_s)([-3.0, -3.0]);
        green > red
    };
    assert_eq!([1.9, 2.0, 11.9, 12.0, 14.0, 36.0, 41.0].map(is_green), [false, true, true, false, false, true, false]);
}

#[test]
fn labels_are_written_at_their_place() {
    let inked = |header: &Header| {
        let colours = colours(header, 0.0);
        let rows = (0..20).flat_map(|row| (0..60).map(move |column| [column, row]));
        let dark = rows.filter(|&[column, row]| {
            let at_m = [1.5 + 0.025 * column as f32, -1.25 + 0.025 * row as f32];
            colours(at_m).iter().all(|code| *code < 140)
        });
        dark.count()
    };
    let mut header = hall();
    assert_eq!(inked(&header), 0);
    header.scenario.labels = vec![PlaceLabel { text: "Till".into(), at_m: Vec2::new(2.2, -1.0) }];
    assert!(inked(&header) > 20);
}

#[test]
fn plots_show_the_markings_too() {
    let count = |header: &Header| {
        let picture = trajectories(header, &Tracks::new(0.1));
        picture.pixels().iter().filter(|pixel| [pixel.red(), pixel.green(), pixel.blue()] == BLUE).count()
    };
    let mut plain = hall();
    plain.scenario.markings.clear();
    assert_eq!(count(&plain), 0);
    assert!(count(&hall()) > 1000);
}
