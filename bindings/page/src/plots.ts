// Small plots in SVG: lines over time with a cursor, and errors against work.

import { element } from "./dom";

export interface Line {
  name: string;
  y: (number | null)[];
}

const WIDTH = 460;
const HEIGHT = 170;
const LEFT = 56;
const BOTTOM = 22;
const TOP = 8;
const RIGHT = 10;
const COLOURS = ["#3b82d6", "#d9773a", "#3f9c5f", "#b558b0", "#c0392b", "#7f8c3a", "#16919e", "#8a6fd1"];

const SVG = "http://www.w3.org/2000/svg";

function svg(tag: string, attributes: Record<string, string | number>, text?: string): SVGElement {
  const made = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) {
    made.setAttribute(name, String(value));
  }
  if (text !== undefined) {
    made.textContent = text;
  }
  return made;
}

// About four round numbers between two limits.
function ticks(low: number, high: number): number[] {
  const raw = (high - low) / 4;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= raw) ?? raw;
  const first = Math.ceil(low / step - 1e-9);
  const count = Math.floor(high / step + 1e-9) - first + 1;
  return Array.from({ length: Math.max(0, count) }, (_, index) => (first + index) * step);
}

function short(number: number): string {
  const size = Math.abs(number);
  return size !== 0 && (size >= 1e4 || size < 1e-3) ? number.toExponential(0).replace("e+", "e") : String(Number(number.toPrecision(3)));
}

interface Frame {
  picture: SVGElement;
  x(value: number): number;
  y(value: number): number;
}

function frame(label: string, [left, right]: [number, number], [low, high]: [number, number], logarithmic: boolean): Frame {
  const picture = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": label });
  const x = (value: number) => LEFT + ((value - left) / (right - left)) * (WIDTH - LEFT - RIGHT);
  const y = (value: number) => HEIGHT - BOTTOM - ((value - low) / (high - low)) * (HEIGHT - BOTTOM - TOP);
  const decades = (from: number, to: number) => {
    const step = Math.max(1, Math.ceil((to - from) / 6));
    return Array.from({ length: Math.floor(to) - Math.ceil(from) + 1 }, (_, index) => Math.ceil(from) + index).filter((at) => at % step === 0);
  };
  const at = (from: number, to: number) => (logarithmic ? decades(from, to) : ticks(from, to));
  const written = (value: number) => (logarithmic ? `1e${value}` : short(value));
  for (const value of at(low, high)) {
    picture.append(
      svg("line", { x1: LEFT, x2: WIDTH - RIGHT, y1: y(value), y2: y(value), class: "gridline" }),
      svg("text", { x: LEFT - 6, y: y(value) + 4, "text-anchor": "end" }, written(value)),
    );
  }
  for (const value of at(left, right)) {
    picture.append(svg("text", { x: x(value), y: HEIGHT - 6, "text-anchor": "middle" }, written(value)));
  }
  return { picture, x, y };
}

function legend(names: string[]): HTMLElement {
  const list = element("p", { class: "legend" });
  names.forEach((name, index) => {
    const swatch = element("i", {});
    swatch.style.background = COLOURS[index % COLOURS.length] ?? "";
    list.append(element("span", {}, swatch, name));
  });
  return list;
}

// Plots lines over time; `moment` moves the cursor.
export function overTime(title: string, t: number[], lines: Line[]): { element: HTMLElement; moment(t: number): void } {
  const values = lines.flatMap((line) => line.y).filter((value) => value !== null);
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  const slack = high > low ? 0.05 * (high - low) : Math.max(1e-12, Math.abs(high) * 0.1);
  const until = t[t.length - 1] ?? 1;
  const { picture, x, y } = frame(title, [0, until > 0 ? until : 1], [low - slack, high + slack], false);
  lines.forEach((line, index) => {
    const points = line.y.map((value, at) => (value === null ? "" : `${x(t[at] ?? 0).toFixed(1)},${y(value).toFixed(1)}`));
    picture.append(svg("polyline", { points: points.join(" "), stroke: COLOURS[index % COLOURS.length] ?? "", class: "curve" }));
  });
  const now = svg("line", { x1: LEFT, x2: LEFT, y1: TOP, y2: HEIGHT - BOTTOM, class: "now" });
  picture.append(now);
  return {
    element: element("figure", {}, element("figcaption", {}, title), picture as unknown as Node, lines.length > 1 ? legend(lines.map((line) => line.name)) : null),
    moment(time: number) {
      now.setAttribute("x1", String(x(time)));
      now.setAttribute("x2", String(x(time)));
    },
  };
}

export interface Curve {
  name: string;
  points: [work: number, error: number][];
}

// Plots errors against work, on logarithmic axes.
export function precision(title: string, curves: Curve[]): HTMLElement {
  const logs = curves.map((curve) => ({
    name: curve.name,
    points: curve.points.filter(([work, error]) => work > 0 && error > 0).map(([work, error]): [number, number] => [Math.log10(work), Math.log10(error)]),
  }));
  const drawn = logs.filter((curve) => curve.points.length > 0);
  const all = drawn.flatMap((curve) => curve.points);
  const range = (place: 0 | 1): [number, number] => {
    const list = all.map((point) => point[place]);
    return [Math.min(...list) - 0.2, Math.max(...list) + 0.2];
  };
  if (all.length === 0) {
    return element("p", { class: "note" }, "No method has results to show.");
  }
  const { picture, x, y } = frame(title, range(0), range(1), true);
  drawn.forEach((curve, index) => {
    const colour = COLOURS[index % COLOURS.length] ?? "";
    picture.append(svg("polyline", { points: curve.points.map(([a, b]) => `${x(a).toFixed(1)},${y(b).toFixed(1)}`).join(" "), stroke: colour, class: "curve" }));
    for (const [a, b] of curve.points) {
      picture.append(svg("circle", { cx: x(a), cy: y(b), r: 2.5, fill: colour }));
    }
  });
  return element("figure", {}, element("figcaption", {}, title), picture as unknown as Node, legend(drawn.map((curve) => curve.name)));
}
