//! A misspelt name, and a statement without its semicolon.

hamel::rigid_eom! {
    system Names {
        param mass_1 = 2;
        coord x;
        velocity v;
        rate x = v;
        particle mass mas_1 at [x, 0, 0];
    }
}

hamel::rigid_eom! {
    system Syntax {
        coord x
        velocity v;
    }
}

fn main() {}
