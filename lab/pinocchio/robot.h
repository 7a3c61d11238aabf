// A robot as plain numbers, so that the URDF reader and the algorithms can be compiled with different options, which
// change the layout of Eigen's matrices.
#pragma once

enum Kind { FREE, ABOUT_X, ABOUT_Y, ABOUT_Z };

// A frame fixed to a joint: rotation in column-major order, and origin (m).
struct Placed {
  int parent;
  double rotation[9];
  double position[3];
};

struct Joint {
  Kind kind;
  Placed at;
  double mass;
  double com[3];
  // About the centre of mass (kg m²): xx, xy, yy, xz, yz, zz.
  double inertia[6];
};

// Joints follow their parents; joint 0 is the world, which `joints` omits.
struct Description {
  int count;
  Joint joints[32];
  Placed link;
};
