//! Rates that leave the manifold, or are not linear.

hamel::rigid_eom! {
    system Leaves {
        coord R: SO3;
        velocity w: vec3;
        rate R = R * diag(w);
        kinetic dot(w, w);
    }
}

hamel::rigid_eom! {
    system Square {
        coord x, y;
        velocity v, w;
        rate x = v * w;
        rate y = w;
        kinetic v^2 + w^2;
    }
}

fn main() {}
