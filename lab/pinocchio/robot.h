// A robot as plain numbers, so that the reader of URDF files and the algorithms may be compiled with different options,
// with which Eigen's matrices are laid out differently.
#pragma once

enum Kind { FREE, ABOUT_X, ABOUT_Y, ABOUT_Z };

// A frame on a joint: axes by columns, then the origin.
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
  // About the centre of mass: xx, xy, yy, xz, yz, zz.
  double inertia[6];
};

// Joints follow their parents; joint 0 is the world, and stands in no list.
struct Description {
  int count;
  Joint joints[32];
  Placed link;
};
