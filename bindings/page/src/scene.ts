// The picture of the mechanism in three.js: bodies as ellipsoids of inertia, frames, joints, springs.

import {
  AmbientLight,
  Box3,
  BufferGeometry,
  Color,
  CylinderGeometry,
  DirectionalLight,
  Float32BufferAttribute,
  GridHelper,
  Group,
  Line,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  Plane,
  PerspectiveCamera,
  Raycaster,
  Scene as Space,
  SphereGeometry,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Scene } from "./answers";

// A point that the pointer holds: a point of a frame in its axes, or a particle.
export type Grip = { frame: number; at: number[] } | { particle: number };

const COLOURS = [0x4f8fd9, 0xe08a4c, 0x5fae78, 0xb877b8, 0xcf6a5f, 0x9aa653, 0x45a5ab, 0x8f83cf];
// Smallest radius of a body, relative to the size of the mechanism.
const MIN_BODY_RADIUS = 0.012;
// Extent of a run, relative to the size of the mechanism, above which the camera follows.
const FOLLOW_EXTENT = 8;

// Reads the vectors of a scene, in the order in which `bindings/page/wasm/src/scenes.rs` writes them.
class Reader {
  private at = 0;
  constructor(private readonly numbers: ArrayLike<number>) {}

  vector(): Vector3 {
    const [x, y, z] = [this.numbers[this.at], this.numbers[this.at + 1], this.numbers[this.at + 2]];
    this.at += 3;
    return new Vector3(x, y, z);
  }

  skip(vectors: number): void {
    this.at += 3 * vectors;
  }
}

export class Stage {
  private readonly space = new Space();
  private readonly camera = new PerspectiveCamera(38, 1, 0.001, 1e5);
  private readonly renderer: WebGLRenderer;
  private readonly controls: OrbitControls;
  private mechanism = new Group();
  private scene: Scene | undefined;
  // Whether the camera follows the mechanism, and the last centre of the mechanism.
  private followed = false;
  private readonly centre = new Vector3();
  private update: (numbers: ArrayLike<number>) => void = () => {};
  // Frames, and parts that can be dragged.
  private frames: LineSegments[] = [];
  private held: { part: Mesh; body: number | null; particle: number }[] = [];

  // `grips` returns whether parts can be dragged; `pulled` is called with every target of a drag, and `released` at its
  // end.
  constructor(
    private readonly holder: HTMLElement,
    private readonly grips: () => boolean,
    private readonly pulled: (grip: Grip, target: number[], sight: number[]) => void,
    private readonly released: () => void,
  ) {
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.holder.append(this.renderer.domElement);
    this.renderer.domElement.setAttribute("role", "img");
    this.renderer.domElement.setAttribute("aria-label", "The mechanism: drag a body to change the start, drag the background to rotate the view, scroll to zoom");
    this.camera.up.set(0, 0, 1);
    // Registered before the listener of the controls, which would rotate the view.
    this.renderer.domElement.addEventListener("pointerdown", (event) => this.take(event));
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.render());
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(2, -3, 5);
    this.space.add(new AmbientLight(0xffffff, 1.3), sun, this.mechanism);
    new ResizeObserver(() => this.resize()).observe(this.holder);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.render());
  }

  // Shows a mechanism with its scenes along a run. For a new one, the camera moves to a distance from which the whole
  // run is visible.
  show(scene: Scene, scenes: ArrayLike<number>[], fresh: boolean): void {
    this.space.remove(this.mechanism);
    dispose(this.mechanism);
    this.mechanism = new Group();
    this.scene = scene;
    this.space.add(this.mechanism);
    const box = extent(scene, scenes);
    const own = extent(scene, scenes.slice(0, 1));
    const reach = scene.bodies.reduce((most, body) => Math.max(most, ...body.radii), 0);
    const size = Math.max(own.getSize(new Vector3()).length(), 2 * reach, 1e-6);
    this.update = this.built(scene, size);
    const whole = Math.max(box.getSize(new Vector3()).length() + 2 * reach, size);
    // A mechanism that moves far would be too small in a view of the whole run.
    this.followed = whole > FOLLOW_EXTENT * size;
    const shown = this.followed ? 2 * size : whole;
    const centre = (this.followed ? own : box).getCenter(new Vector3());
    this.centre.copy(centre);
    const distance = (0.62 * shown) / Math.tan((this.camera.fov * Math.PI) / 360);
    if (fresh) {
      this.camera.position.copy(centre).add(new Vector3(0.62, -0.95, 0.42).normalize().multiplyScalar(distance));
      this.camera.near = distance / 200;
      this.camera.far = distance * 50;
      this.controls.target.copy(centre);
    }
    if (!this.followed) {
      const ground = new GridHelper(2 * whole, 20, 0x8a8f99, 0x8a8f99);
      ground.material.transparent = true;
      ground.material.opacity = 0.22;
      ground.rotation.x = Math.PI / 2;
      ground.position.set(centre.x, centre.y, Math.min(0, box.min.z));
      this.mechanism.add(ground);
    }
    this.resize();
    this.controls.update();
  }

  // Moves all parts to the places of a scene.
  move(numbers: ArrayLike<number>): void {
    this.update(numbers);
    if (this.followed && this.scene !== undefined) {
      const centre = extent(this.scene, [numbers]).getCenter(new Vector3());
      const by = centre.clone().sub(this.centre);
      this.centre.copy(centre);
      this.camera.position.add(by);
      this.controls.target.add(by);
    }
    this.render();
  }

  // Begins to drag a body or particle, in the plane through it that is parallel to the screen.
  private take(event: PointerEvent): void {
    if (event.button !== 0 || !this.grips()) {
      return;
    }
    const canvas = this.renderer.domElement;
    const ray = (at: PointerEvent) => {
      const box = canvas.getBoundingClientRect();
      const caster = new Raycaster();
      const [x, y] = [(at.clientX - box.left) / box.width, (at.clientY - box.top) / box.height];
      caster.setFromCamera(new Vector2(2 * x - 1, 1 - 2 * y), this.camera);
      return caster;
    };
    const [hit] = ray(event).intersectObjects(this.held.map(({ part }) => part));
    const found = this.held.find(({ part }) => part === hit?.object);
    if (hit === undefined || found === undefined) {
      return;
    }
    const frame = this.frames[found.body ?? -1];
    const grip: Grip =
      found.body === null || frame === undefined
        ? { particle: found.particle }
        : { frame: found.body, at: hit.point.clone().applyMatrix4(frame.matrix.clone().invert()).toArray() };
    const plane = new Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new Vector3()), hit.point);
    this.controls.enabled = false;
    canvas.setPointerCapture(event.pointerId);
    canvas.onpointermove = (move) => {
      const { ray: line } = ray(move);
      const target = line.intersectPlane(plane, new Vector3());
      if (target !== null) {
        this.pulled(grip, target.toArray(), line.direction.toArray());
      }
    };
    canvas.onpointerup = canvas.onpointercancel = () => {
      canvas.onpointermove = canvas.onpointerup = canvas.onpointercancel = null;
      this.controls.enabled = true;
      this.released();
    };
  }

  // Projects a point of the world to the window (pixels).
  place(point: number[]): [x: number, y: number] {
    const box = this.renderer.domElement.getBoundingClientRect();
    const { x, y } = new Vector3().fromArray(point).project(this.camera);
    return [box.left + ((x + 1) / 2) * box.width, box.top + ((1 - y) / 2) * box.height];
  }

  private render(): void {
    this.renderer.render(this.space, this.camera);
  }

  // Number of draw calls of the last frame.
  get calls(): number {
    return this.renderer.info.render.calls;
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.holder;
    if (width > 0 && height > 0) {
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      this.render();
    }
  }

  // Creates the parts of a mechanism, and returns the function that moves them.
  private built(scene: Scene, size: number): (numbers: ArrayLike<number>) => void {
    const add = <T extends Mesh | Line>(part: T): T => {
      part.frustumCulled = false;
      part.matrixAutoUpdate = false;
      this.mechanism.add(part);
      return part;
    };
    const ball = new SphereGeometry(1, 32, 20);
    const frames = scene.frames.map(() => add(triad(0.13 * size)));
    this.frames = frames;
    const links = scene.frames.map((frame) => (frame.attached ? add(segment(0x8a8f99)) : null));
    const bodies = scene.bodies.map((_, index) =>
      add(new Mesh(ball, new MeshStandardMaterial({ color: colour(index), roughness: 0.55, transparent: true, opacity: 0.88 }))),
    );
    const particles = scene.particles.map((_, index) => add(new Mesh(ball, new MeshStandardMaterial({ color: colour(index), roughness: 0.5 }))));
    const pin = new CylinderGeometry(0.022 * size, 0.022 * size, 0.11 * size, 20).rotateX(Math.PI / 2);
    const joints = scene.joints.map((joint) => joint.axes.map(() => add(new Mesh(pin, new MeshStandardMaterial({ color: 0x7a808c, roughness: 0.4 })))));
    const lines = scene.lines.map((line) => add(line.acts === "spring" ? coil() : segment(line.acts === "damper" ? 0x9aa653 : 0xcf6a5f)));
    const rods = scene.rods.map(() => add(segment(0x8a8f99)));
    // The two points that a loop joins, and a line between them if the loop is open.
    const closed = () => add(new Mesh(ball, new MeshStandardMaterial({ color: 0xcf6a5f, roughness: 0.4, wireframe: true })));
    const loops = scene.loops.map(() => ({ ends: [closed(), closed()], gap: add(segment(0xcf6a5f)) }));
    const centre = scene.centre === null ? null : add(new Mesh(ball, new MeshStandardMaterial({ color: 0xd9b13a })));
    this.held = [
      ...bodies.map((part, index) => ({ part, body: scene.bodies[index]?.frame ?? null, particle: 0 })),
      ...particles.map((part, index) => ({ part, body: null, particle: index })),
    ];
    const mass = scene.particles.reduce((most, particle) => Math.max(most, particle.mass), 0);
    return (numbers) => {
      const reader = new Reader(numbers);
      const places: Vector3[] = [];
      scene.frames.forEach((frame, index) => {
        // Vectors interpolated between two samples are slightly shorter than 1.
        const rows = [reader.vector().normalize(), reader.vector().normalize(), reader.vector().normalize()] as const;
        const place = reader.vector();
        places.push(place);
        const [a, b, c] = rows;
        frames[index]?.matrix.set(a.x, a.y, a.z, place.x, b.x, b.y, b.z, place.y, c.x, c.y, c.z, place.z, 0, 0, 0, 1);
        const from = frame.parent === null ? new Vector3() : (places[frame.parent] ?? new Vector3());
        stretch(links[index] ?? null, from, place, 1);
      });
      scene.bodies.forEach((body, index) => {
        const at = reader.vector();
        const [a, b, c] = [reader.vector(), reader.vector(), reader.vector()];
        const [i = 0, j = 0, k = 0] = body.radii.map((radius) => Math.max(radius, MIN_BODY_RADIUS * size));
        bodies[index]?.matrix.makeBasis(a.setLength(i), b.setLength(j), c.setLength(k)).setPosition(at);
      });
      scene.particles.forEach((particle, index) => {
        const radius = 0.05 * size * Math.cbrt(mass > 0 ? Math.max(particle.mass / mass, 0.05) : 1);
        particles[index]?.matrix.makeScale(radius, radius, radius).setPosition(reader.vector());
      });
      scene.joints.forEach((joint, index) => {
        const at = reader.vector();
        joint.axes.forEach((_, axis) => joints[index]?.[axis]?.matrix.copy(along(reader.vector())).setPosition(at));
      });
      scene.lines.forEach((_, index) => stretch(lines[index] ?? null, reader.vector(), reader.vector(), 0.035 * size));
      scene.rods.forEach((_, index) => stretch(rods[index] ?? null, reader.vector(), reader.vector(), 1));
      for (const { ends, gap } of loops) {
        const points = [reader.vector(), reader.vector()] as const;
        ends.forEach((end, at) => end.matrix.makeScale(0.018 * size, 0.018 * size, 0.018 * size).setPosition(points[at] ?? points[0]));
        stretch(gap, points[0], points[1], 1);
      }
      if (centre !== null) {
        const radius = 0.012 * size;
        centre.matrix.makeScale(radius, radius, radius).setPosition(reader.vector());
      }
    };
  }
}

// Frees the GPU memory of parts.
function dispose(parts: Group): void {
  parts.traverse((part) => {
    if (part instanceof Mesh || part instanceof Line) {
      part.geometry.dispose();
      part.material.dispose();
    }
  });
}

function colour(index: number): number {
  return COLOURS[index % COLOURS.length] ?? 0x888888;
}

// The bounding box of the frames, bodies, particles and lines of scenes.
function extent(scene: Scene, scenes: ArrayLike<number>[]): Box3 {
  const box = new Box3();
  const add = (point: Vector3) => {
    if (Number.isFinite(point.x + point.y + point.z)) {
      box.expandByPoint(point);
    }
  };
  for (const numbers of scenes) {
    const reader = new Reader(numbers);
    for (const _ of scene.frames) {
      reader.skip(3);
      add(reader.vector());
    }
    for (const _ of scene.bodies) {
      add(reader.vector());
      reader.skip(3);
    }
    for (const _ of scene.particles) {
      add(reader.vector());
    }
    for (const joint of scene.joints) {
      reader.skip(1 + joint.axes.length);
    }
    for (const _ of [...scene.lines, ...scene.rods]) {
      add(reader.vector());
      add(reader.vector());
    }
  }
  return box.isEmpty() ? new Box3(new Vector3(-1, -1, -1), new Vector3(1, 1, 1)) : box;
}

function triad(length: number): LineSegments {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute([0, 0, 0, length, 0, 0, 0, 0, 0, 0, length, 0, 0, 0, 0, 0, 0, length], 3));
  const [r, g, b] = [new Color(0xd04a3c), new Color(0x3f9c5f), new Color(0x3b72d6)].map((c) => [c.r, c.g, c.b]) as [number[], number[], number[]];
  geometry.setAttribute("color", new Float32BufferAttribute([...r, ...r, ...g, ...g, ...b, ...b], 3));
  return new LineSegments(geometry, new LineBasicMaterial({ vertexColors: true, depthTest: false }));
}

// A line along z from 0 to 1.
function segment(color: number): Line {
  const geometry = new BufferGeometry().setFromPoints([new Vector3(), new Vector3(0, 0, 1)]);
  return new Line(geometry, new LineBasicMaterial({ color }));
}

// A coil of radius 1 along z from 0 to 1.
function coil(): Line {
  const turns = 9;
  const points = [new Vector3()];
  for (let step = 0; step <= 24 * turns; step += 1) {
    const angle = (step * Math.PI) / 12;
    points.push(new Vector3(Math.cos(angle), Math.sin(angle), 0.08 + (0.84 * step) / (24 * turns)));
  }
  points.push(new Vector3(0, 0, 1));
  return new Line(new BufferGeometry().setFromPoints(points), new LineBasicMaterial({ color: 0x5fae78 }));
}

// A rotation that takes the z axis to a direction.
function along(direction: Vector3): Matrix4 {
  const z = direction.clone().normalize();
  const helper = Math.abs(z.x) < 0.8 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
  const x = helper.cross(z).normalize();
  return new Matrix4().makeBasis(x, new Vector3().crossVectors(z, x), z);
}

// Places a part that extends along z from 0 to 1 between two points.
function stretch(part: Line | null, from: Vector3, to: Vector3, width: number): void {
  if (part === null) {
    return;
  }
  const direction = to.clone().sub(from);
  const length = direction.length();
  const turn = length > 0 ? along(direction) : new Matrix4();
  part.matrix.copy(turn.multiply(new Matrix4().makeScale(width, width, Math.max(length, 1e-9)))).setPosition(from);
}
