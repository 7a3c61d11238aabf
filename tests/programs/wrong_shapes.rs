//! Wrong shapes, all of which are reported.

hamel::rigid_eom! {
    system Shapes {
        coord R: SO3;
        velocity w: vec3;
        rate R = R * w;
        frame f = pose(R, [0, 0, 0]);
        body on f { mass 1; com [0, 0]; inertia w; }
        gravity 9.81;
    }
}

fn main() {}
