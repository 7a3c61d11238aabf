//! Wrong inertias: reference point, symmetry, positive definiteness.

hamel::rigid_eom! {
    system Bodies {
        param l = 1;
        coord R: SO3;
        velocity w: vec3;
        rate R = R * hat(w);
        frame f = pose(R, [0, 0, 0]);
        body on f { mass 1; com [0, 0, l]; inertia diag(1, 2, 3); }
        body on f { mass 1; inertia [[1, 2, 0], [0, 1, 0], [0, 0, 1]]; }
    }
}

hamel::rigid_eom! {
    system Massless {
        coord x, y;
        velocity v, w;
        rate x = v;
        rate y = w;
        particle mass 1 at [x, 0, 0];
    }
}

fn main() {}
