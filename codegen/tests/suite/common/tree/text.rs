//! The description of a tree of links.

use super::{GRAVITY, Kind, Link, second};
use std::fmt::Write;

fn list(v: &[f64; 3]) -> String {
    format!("[{}, {}, {}]", v[0], v[1], v[2])
}

fn pose(rpy: &[f64; 3], place: &[f64; 3]) -> String {
    let rotation = match rpy {
        [0.0, 0.0, 0.0] => "identity(3)".to_owned(),
        [r, p, y] => format!("rpy({r}, {p}, {y})"),
    };
    format!("pose({rotation}, {})", list(place))
}

/// Returns the description of a tree that requests these functions.
pub fn text(links: &[Link], functions: &str) -> String {
    let mut text = String::from("system Tree {\n    input u;\n");
    for (index, link) in links.iter().enumerate() {
        let on = link.parent.map_or(String::new(), |parent| {
            let frame = if link.beyond(links) { "g" } else { "f" };
            format!(" on {frame}{parent}")
        });
        let axis = list(&link.axis);
        let kind = match link.kind {
            Kind::Revolute => format!("revolute {axis}"),
            Kind::Continuous => format!("continuous {axis}"),
            Kind::Prismatic => format!("prismatic {axis}"),
            Kind::Cylindrical => format!("cylindrical {axis}"),
            Kind::Planar => format!("planar {axis}"),
            Kind::Universal => format!("universal {axis}, {}", list(&second(link.axis))),
            Kind::Spherical => "spherical".to_owned(),
            Kind::Quaternion => "spherical S3".to_owned(),
            Kind::Free => "free".to_owned(),
            Kind::Fixed => "fixed".to_owned(),
        };
        let follows = link.follows.as_ref().map_or(String::new(), |follow| {
            let (q, [a, b, c]) = (follow.source, follow.law);
            match c {
                0.0 => format!(" follows {a} + {b} * q{q}"),
                _ => format!(" follows {a} + {b} * q{q} + {c} * q{q}^2"),
            }
        });
        let place = pose(&link.rpy, &link.place);
        let _ = write!(
            text,
            "    joint q{index}: {kind}{on} at {place} moves f{index}{follows}"
        );
        let mut fields = String::new();
        for (name, value) in [
            ("damping", link.damping),
            ("armature", link.armature),
            ("stiffness", link.stiffness),
        ] {
            if value != 0.0 {
                let _ = write!(fields, "{name} {value}; ");
            }
        }
        if link.stiffness != 0.0 {
            let _ = write!(fields, "rest {}; ", link.rest);
        }
        if link.force != 0.0 {
            let _ = write!(fields, "force {} * u; ", link.force);
        }
        let _ = match fields.as_str() {
            "" => writeln!(text, ";"),
            _ => writeln!(text, " {{ {fields}}};"),
        };
        let mut frame = format!("f{index}");
        if let Some((rpy, place)) = &link.user {
            let _ = writeln!(
                text,
                "    frame g{index} on {frame} = {};",
                pose(rpy, place)
            );
            frame = format!("g{index}");
        }
        let [x, y, z, yz, xz, xy] = link.inertia;
        let _ = writeln!(
            text,
            "    body on {frame} {{ mass {}; com {}; inertia [[{x}, {xy}, {xz}], [{xy}, {y}, {yz}], [{xz}, {yz}, {z}]] about com; }}",
            link.mass,
            list(&link.com),
        );
        if let Some((mass, place)) = &link.particle {
            let _ = writeln!(
                text,
                "    particle mass {mass} at {} on {frame};",
                list(place)
            );
        }
        if let Some((force, point)) = &link.push {
            let [a, b, c] = force;
            let _ = writeln!(
                text,
                "    force [{a} * u, {b} * u, {c} * u] at {} on {frame} in body;",
                list(point)
            );
        }
    }
    let _ = writeln!(
        text,
        "    gravity {};\n    generate {functions};\n}}",
        list(&GRAVITY)
    );
    text
}
