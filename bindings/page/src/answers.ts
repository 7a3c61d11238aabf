// Types of the generator's answers, written by `bindings/page/wasm/src/requests.rs`.

export interface Mark {
  severity: "error" | "warning";
  range: [number, number] | null;
  message: string;
  help: string | null;
  notes: { range: [number, number] | null; label: string }[];
}

export interface Names {
  entries: string[];
  groups: [name: string, first: number, count: number][];
}

export interface Start {
  params: number[];
  x: number[];
  xi: number[];
  u: number[];
}

export interface System {
  name: string;
  coordinates: Names;
  kinds: string[];
  velocities: Names;
  inputs: Names;
  parameters: Names;
  methods: string[];
  start: Start;
}

export interface Opened {
  system: System | null;
  marks: Mark[];
  said: string;
}

export interface Imported {
  text: string | null;
  said: string;
}

export interface Indexed {
  index: string;
  left: string;
}

export interface Definition {
  left: string;
  value: string;
}

export interface Table {
  name: string;
  symbol: string;
  title: string;
  size: number;
  nonzero: number;
  groups: { value: string; plus: Indexed[]; minus: Indexed[] }[];
  entries: { left: string; value: string; reads: string }[];
  before: Definition[];
  after: Definition[];
}

export interface Tables {
  system: string;
  coordinates: string[];
  velocities: string[];
  tables: Table[];
}

export interface Checked {
  identities: { label: string; equation: string; verdict: string; told: string }[];
  remarks: string;
}

export interface Counts {
  add: number;
  mul: number;
  div: number;
  sqrt: number;
  sincos: number;
  other: number;
  flops: number;
}

export interface Operations {
  functions: Record<string, { shared: Counts; unshared: Partial<Counts> }>;
  parameters: { hoisted: Counts; kept: number };
}

export interface Advice {
  choices: {
    velocities: string;
    as_written: string;
    accel: Counts;
    rate: Counts;
    statements: string[];
  }[];
}

export interface Track {
  name: string;
  width: number;
  values: (number | null)[];
}

export type Vector = [number, number, number];

// What can be drawn at one state; the generator says what the members are, in `engine/src/drawing/scene.rs`.
export interface Scene {
  frames: { name: string; parent: number | null; attached: boolean; rotation: [Vector, Vector, Vector]; position: Vector }[];
  bodies: { frame: number; mass: number; centre: Vector; axes: [Vector, Vector, Vector]; radii: Vector }[];
  particles: { mass: number; position: Vector }[];
  joints: { name: string; kind: string; frame: number; place: Vector; axes: Vector[] }[];
  lines: { acts: "spring" | "damper" | "force"; points: [Vector, Vector] }[];
  rods: [Vector, Vector][];
  loops: [Vector, Vector][];
  centre: Vector | null;
}

export interface Run {
  t: number[];
  x: number[];
  xi: number[];
  energy: (number | null)[];
  outputs: Track[];
  invariants: Track[];
  method: string;
  reason: string | null;
  steps: number;
  evaluations: number;
  /** Largest relative change of the energy; `null` if all energy was supplied during the run. */
  drift: number | null;
  constraint: number;
  failure: string | null;
  // Scene at the start, or `null` if nothing can be drawn; `width` is the number of `numbers` that place the scene at
  // one sample.
  scene: Scene | null;
  // Parts that are not drawn, with the statement that would give them a place.
  missing: string[];
  width: number;
  numbers?: Float32Array;
}

// The start after a point was dragged, with the numbers of its scene.
export interface Pulled {
  x: number[];
  xi: number[];
  numbers?: Float32Array;
}

export interface Case {
  reference: string;
  methods: {
    method: string;
    kind: string;
    runs: { steps: number; evaluations: number | null; error: number | null }[];
  }[];
}
