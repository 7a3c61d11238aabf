// Editable fields of the start of a run: numbers, angles of circles, and rotation vectors that are applied after the
// rotation of the description. Dragging a label sideways changes its number.

import type { System } from "./answers";
import { element } from "./dom";

type Value = number | number[] | number[][] | { p: number[]; R: number[][] };

interface Field {
  kind: string;
  name: string;
  start: number[];
  numbers: number[];
}

export class Start {
  readonly element = element("div", { class: "start" });
  private readonly coordinates: Field[];
  private readonly velocities: Field[];

  constructor(
    private readonly system: System,
    private readonly changed: () => void,
  ) {
    const { x, xi } = system.start;
    this.coordinates = system.coordinates.groups.map(([name, first, count], index) => {
      const kind = system.kinds[index] ?? "real";
      const start = x.slice(first, first + count);
      return { kind, name, start, numbers: shown(kind, start) };
    });
    this.velocities = system.velocities.groups.map(([name, first, count]) => {
      const start = xi.slice(first, first + count);
      return { kind: "plain", name, start, numbers: [...start] };
    });
    for (const [title, fields] of [
      ["Coordinates", this.coordinates],
      ["Velocities", this.velocities],
    ] as const) {
      this.element.append(element("h4", {}, title), ...fields.flatMap((field) => this.inputs(field)));
    }
  }

  // Returns the start of a request: the numbers of the description, and the changes to them.
  asked(): { x: number[]; xi: number[]; state: object | null } {
    const { x, xi } = this.system.start;
    return { x, xi, state: this.state() };
  }

  // Returns the changed values in the state format of the command line, or `null`.
  private state(): { coord: Record<string, Value>; velocity: Record<string, Value> } | null {
    const values = (fields: Field[]) => {
      const moved = fields.filter((field) => {
        const before = field.kind === "plain" ? field.start : shown(field.kind, field.start);
        return field.numbers.some((number, index) => number !== before[index]);
      });
      return Object.fromEntries(moved.map((field) => [field.name, value(field)]));
    };
    const [coord, velocity] = [values(this.coordinates), values(this.velocities)];
    return Object.keys(coord).length + Object.keys(velocity).length === 0 ? null : { coord, velocity };
  }

  private inputs(field: Field): Node[] {
    return field.numbers.map((number, index) => {
      const label = labelled(field, index);
      const input = element("input", { type: "number", step: "any", value: String(round(number)), "aria-label": label });
      const handle = element("span", { class: "handle", title: "drag sideways to change" }, label);
      const set = (to: number) => {
        if (Number.isFinite(to)) {
          field.numbers[index] = to;
          this.changed();
        }
      };
      input.oninput = () => set(input.valueAsNumber);
      handle.onpointerdown = (event) => {
        handle.setPointerCapture(event.pointerId);
        const [from, at] = [event.clientX, field.numbers[index] ?? 0];
        handle.onpointermove = (move) => {
          const to = round(at + (move.clientX - from) * 0.01);
          input.value = String(to);
          set(to);
        };
        handle.onpointerup = () => (handle.onpointermove = null);
      };
      return element("label", { class: "entry" }, handle, input);
    });
  }
}

// The numbers that the fields of a coordinate show.
function shown(kind: string, start: number[]): number[] {
  switch (kind) {
    case "S1":
      return [Math.atan2(start[1] ?? 0, start[0] ?? 1)];
    case "S3":
    case "SO3":
      return [0, 0, 0];
    case "SE3":
      return [...start.slice(0, 3), 0, 0, 0];
    default:
      return [...start];
  }
}

function labelled(field: Field, index: number): string {
  const axis = ["x", "y", "z"];
  switch (field.kind) {
    case "S1":
      return `angle of ${field.name}`;
    case "S3":
    case "SO3":
      return `rotation of ${field.name}, ${axis[index]}`;
    case "SE3":
      return index < 3 ? `${field.name}.p[${index + 1}]` : `rotation of ${field.name}.R, ${axis[index - 3]}`;
    default:
      return field.numbers.length === 1 ? field.name : `${field.name}[${index + 1}]`;
  }
}

function value(field: Field): Value {
  const { kind, start, numbers } = field;
  switch (kind) {
    case "S1":
      return numbers[0] ?? 0;
    case "S3":
      return turned(start, numbers);
    case "SO3":
      return product(rows(start), rotation(numbers));
    case "SE3":
      return { p: numbers.slice(0, 3), R: product(rows(start.slice(3)), rotation(numbers.slice(3))) };
    default:
      return numbers.length === 1 && (kind === "real" || start.length === 1) ? (numbers[0] ?? 0) : numbers;
  }
}

function rows(entries: number[]): number[][] {
  return [0, 3, 6].map((first) => entries.slice(first, first + 3));
}

function product(a: number[][], b: number[][]): number[][] {
  return a.map((row) => [0, 1, 2].map((j) => row.reduce((sum, entry, k) => sum + entry * (b[k]?.[j] ?? 0), 0)));
}

// The rotation matrix of a rotation vector: I + sin t/t hat v + (1 − cos t)/t² hat v hat v.
function rotation([x = 0, y = 0, z = 0]: number[]): number[][] {
  const t = Math.hypot(x, y, z);
  const [a, b] = t < 1e-9 ? [1, 0.5] : [Math.sin(t) / t, (1 - Math.cos(t)) / (t * t)];
  const hat = [
    [0, -z, y],
    [z, 0, -x],
    [-y, x, 0],
  ];
  const square = product(hat, hat);
  return hat.map((row, i) => row.map((entry, j) => (i === j ? 1 : 0) + a * entry + b * (square[i]?.[j] ?? 0)));
}

// The product of a unit quaternion, scalar first, and the quaternion of a rotation vector.
function turned([s = 1, a = 0, b = 0, c = 0]: number[], [x = 0, y = 0, z = 0]: number[]): number[] {
  const t = Math.hypot(x, y, z);
  const [p, k] = [Math.cos(t / 2), t < 1e-9 ? 0.5 : Math.sin(t / 2) / t];
  const [u, v, w] = [k * x, k * y, k * z];
  return [s * p - a * u - b * v - c * w, s * u + a * p + b * w - c * v, s * v - a * w + b * p + c * u, s * w + a * v - b * u + c * p];
}

function round(number: number): number {
  return Number(number.toPrecision(6));
}
