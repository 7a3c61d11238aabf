// The panel of the motion: a run from an editable start, its picture and plots, and a comparison of methods.

import type { Case, Pulled, Run, System } from "./answers";
import { element } from "./dom";
import { Superseded, type Generator } from "./generator";
import { overTime, precision, type Line } from "./plots";
import { type Grip, Stage } from "./scene";
import { Start } from "./start";

// Time after the last change of a number before a new run starts (ms).
const DEBOUNCE_MS = 120;
// Time after which a run is shown as running (ms).
const SHOW_RUNNING_AFTER_MS = 500;
// Largest number of lines in a plot, and of plots of outputs and invariants.
const MAX_LINES = 8;
// Numbers of steps of a comparison, and its largest length (s).
const COMPARISON_STEPS = [50, 100, 200, 400, 800];
const MAX_COMPARISON_TIME = 5;

export class Motion {
  private stage: Stage | undefined;
  private run: Run | undefined;
  // Numbers of the scene at each sample, and at the displayed time.
  private scenes: Float32Array[] = [];
  private between = new Float32Array();
  private system: System | undefined;
  private start: Start | undefined;
  // The next pull, whether one is being computed, and whether the pointer holds a body.
  private waiting: (() => Promise<void>) | undefined;
  private pulling = false;
  private held = false;
  private moments: ((t: number) => void)[] = [];
  private playing = false;
  private time = 0;
  private last = 0;
  // Names of the entries of ξ.
  private names: string[] = [];
  private resting: number | undefined;
  // Number of the latest run.
  private turn = 0;

  private readonly method = element("select", { id: "method" });
  private readonly until = element("input", { type: "number", min: "0", step: "any", value: "10", id: "until" });
  private readonly step = element("input", { type: "number", min: "0", step: "any", placeholder: "auto", id: "step" });
  private readonly speed = element("input", { type: "number", min: "0", step: "any", value: "1", id: "speed" });
  private readonly play = element("button", { type: "button", id: "play" }, "Play");
  private readonly scrub = element("input", { type: "range", min: "0", max: "1", step: "any", value: "0", "aria-label": "Time" });
  private readonly clock = element("output", { class: "clock" }, "0 s");
  private readonly view = element("div", { class: "stage" });
  private readonly plots = element("div", { class: "plots" });
  private readonly summary = element("p", { class: "note", role: "status", id: "summary" });
  private readonly fields = element("div", {});
  private readonly missing = element("p", { class: "note", id: "missing" });
  private readonly reset = element("button", { type: "button", id: "reset" }, "Reset to the start in the text");
  private readonly comparison = element("div", {});

  constructor(
    panel: HTMLElement,
    private readonly generator: Generator,
  ) {
    const field = (text: string, input: HTMLElement) => element("label", { class: "field" }, text, input);
    const compare = element("button", { type: "button", id: "compare" }, "Compare methods");
    panel.replaceChildren(
      element("div", { class: "controls" }, field("method", this.method), field("until (s)", this.until), field("step (s)", this.step)),
      this.summary,
      this.view,
      this.missing,
      element("div", { class: "controls" }, this.play, this.scrub, this.clock, field("speed", this.speed)),
      this.plots,
      element("details", { open: "" }, element("summary", {}, "Start"), element("p", { class: "note" }, "Type a number, drag its name sideways, or, while the time is 0, drag a body in the picture."), this.fields, this.reset),
      element("h3", {}, "Error against work", compare),
      this.comparison,
    );
    for (const input of [this.method, this.until, this.step]) {
      input.onchange = () => this.again();
    }
    this.play.onclick = () => this.toggle();
    this.scrub.oninput = () => {
      this.pause();
      this.show(this.scrub.valueAsNumber);
    };
    compare.onclick = () => void this.compare();
    this.reset.onclick = () => {
      if (this.system !== undefined) {
        this.begin(this.system);
        this.again();
      }
    };
  }

  // Creates the fields for the start of a system.
  private begin(system: System): void {
    this.start = new Start(system, () => this.again());
    this.fields.replaceChildren(this.start.element);
    this.reset.hidden = system === this.system;
  }

  // Projects a point of the world to the window, for tests.
  place(point: number[]): [number, number] | undefined {
    return this.stage?.place(point);
  }

  // Changes the start so that a point of the mechanism is at the pointer, or near it. One pull is computed at a time,
  // and the last one always.
  private pull(grip: Grip, target: number[], sight: number[]): void {
    this.held = true;
    this.waiting = async () => {
      const pulled = await this.generator.ask<Pulled>("pull", { ...this.start?.asked(), ...grip, target, sight });
      if (this.system === undefined || pulled.numbers === undefined) {
        return;
      }
      this.begin({ ...this.system, start: { ...this.system.start, x: pulled.x, xi: pulled.xi } });
      this.stage?.move(pulled.numbers);
    };
    if (!this.pulling) {
      void this.pullOn();
    }
  }

  private async pullOn(): Promise<void> {
    this.pulling = true;
    try {
      while (this.waiting !== undefined) {
        const next = this.waiting;
        this.waiting = undefined;
        await next();
      }
    } catch (error) {
      this.refused(error);
    } finally {
      this.pulling = false;
    }
    this.letGo();
  }

  // Starts a run after the body is released and the last pull is computed.
  private letGo(): void {
    if (!this.held && !this.pulling) {
      this.again();
    }
  }

  // Shows a new system, and runs it.
  async of(system: System): Promise<void> {
    const before = this.method.value;
    this.method.replaceChildren(...system.methods.map((name) => element("option", {}, name)));
    this.method.value = system.methods.includes(before) ? before : "auto";
    this.names = system.velocities.entries;
    this.system = system;
    this.begin(system);
    this.comparison.replaceChildren();
    await this.integrate(true);
  }

  // Sets the length of runs (s).
  lasts(until: number): void {
    this.until.value = String(until);
  }

  // Draws the displayed time again.
  draw(): void {
    this.show(this.time);
  }

  // Measures the median time of a frame of the animation (ms), and its number of draw calls.
  measure(frames: number): { frame: number; calls: number } {
    const times = Array.from({ length: frames }, (_, at) => {
      const begin = performance.now();
      this.show((Number(this.scrub.max) * at) / frames);
      return performance.now() - begin;
    });
    times.sort((a, b) => a - b);
    return { frame: times[frames >> 1] ?? NaN, calls: this.stage?.calls ?? 0 };
  }

  private again(): void {
    clearTimeout(this.resting);
    this.resting = window.setTimeout(() => {
      this.integrate(false).catch((error: unknown) => this.refused(error));
    }, DEBOUNCE_MS);
  }

  private refused(error: unknown): void {
    if (!(error instanceof Superseded)) {
      this.summary.classList.add("bad");
      this.summary.textContent = error instanceof Error ? error.message : String(error);
    }
  }

  private asked(): object {
    const step = this.step.valueAsNumber;
    return {
      // The generator reports invalid lengths.
      until: Number.isNaN(this.until.valueAsNumber) ? 10 : this.until.valueAsNumber,
      ...(Number.isNaN(step) ? {} : { step }),
      method: this.method.value,
      scenes: true,
      ...this.start?.asked(),
    };
  }

  private async integrate(fresh: boolean): Promise<void> {
    const turn = ++this.turn;
    const slow = window.setTimeout(() => (this.summary.textContent = "running…"), SHOW_RUNNING_AFTER_MS);
    let run: Run;
    try {
      run = await this.generator.instead<Run>("simulate", this.asked());
    } catch (error) {
      // Errors of a superseded run are ignored.
      if (turn === this.turn) {
        this.refused(error);
        if (error instanceof Superseded) {
          throw error;
        }
      }
      return;
    } finally {
      clearTimeout(slow);
    }
    this.run = run;
    const reason = run.reason === null ? "" : `, chosen because ${run.reason}`;
    this.summary.classList.toggle("bad", run.failure !== null);
    const drift = run.drift === null ? "all energy is supplied from outside" : `relative change of the energy at most ${run.drift.toExponential(1)}`;
    this.summary.textContent = run.failure ?? `${run.method}${reason}; ${run.steps.toLocaleString("en")} steps, ${drift}`;
    this.summary.dataset["drift"] = String(run.drift);
    const { scene, width, numbers } = run;
    this.view.hidden = scene === null || numbers === undefined;
    const nothing = "There is nothing to draw: a statement such as `frame f = pose(R, r);` would give a part of the mechanism a place.";
    const missing = run.missing.map((part) => `Not drawn: ${part}.`);
    this.missing.replaceChildren([...(scene === null ? [nothing] : []), ...missing].join(" "));
    if (scene !== null && numbers !== undefined) {
      this.stage ??= new Stage(
        this.view,
        () => !this.playing && this.time === 0,
        (grip, target, sight) => this.pull(grip, target, sight),
        () => {
          this.held = false;
          this.letGo();
        },
      );
      const scenes = Array.from({ length: numbers.length / width }, (_, at) => numbers.subarray(at * width, (at + 1) * width));
      this.stage.show(scene, scenes, fresh);
      this.scenes = scenes;
      this.between = new Float32Array(width);
    }
    this.plot(run);
    this.scrub.max = String(run.t[run.t.length - 1] ?? 0);
    this.show(fresh ? 0 : Math.min(this.time, run.t[run.t.length - 1] ?? 0));
  }

  private plot(run: Run): void {
    const names = this.names;
    const count = run.t.length;
    const wide = run.xi.length / count;
    const velocities: Line[] = names.slice(0, MAX_LINES).map((name, index) => ({ name, y: run.t.map((_, at) => run.xi[at * wide + index] ?? null) }));
    const first = run.energy[0] ?? 0;
    const energy: Line[] = [{ name: "energy", y: run.energy.map((value) => (value === null ? null : value - first)) }];
    const pictures = [overTime(names.length > MAX_LINES ? `velocities, the first ${MAX_LINES}` : "velocities", run.t, velocities), overTime(`energy minus its initial value, ${first.toPrecision(4)}`, run.t, energy)];
    const tracks = [
      ...run.invariants.map((track) => ({ ...track, title: `invariant ${track.name}` })),
      ...run.outputs.map((track) => ({ ...track, title: `output ${track.name}` })),
    ];
    for (const track of tracks.slice(0, MAX_LINES)) {
      const lines = Array.from({ length: Math.min(track.width, MAX_LINES) }, (_, entry): Line => ({
        name: track.width === 1 ? track.name : `${track.name}[${entry + 1}]`,
        y: run.t.map((_, at) => track.values[at * track.width + entry] ?? null),
      }));
      pictures.push(overTime(track.title, run.t, lines));
    }
    this.plots.replaceChildren(...pictures.map((picture) => picture.element));
    this.moments = pictures.map((picture) => picture.moment);
  }

  private toggle(): void {
    if (this.playing) {
      this.pause();
      return;
    }
    this.playing = true;
    this.play.textContent = "Pause";
    if (this.time >= Number(this.scrub.max)) {
      this.time = 0;
    }
    this.last = performance.now();
    requestAnimationFrame((now) => this.tick(now));
  }

  private pause(): void {
    this.playing = false;
    this.play.textContent = "Play";
  }

  private tick(now: number): void {
    if (!this.playing) {
      return;
    }
    const speed = this.speed.valueAsNumber > 0 ? this.speed.valueAsNumber : 1;
    this.show(this.time + (speed * Math.max(0, now - this.last)) / 1000);
    this.last = now;
    if (this.time >= Number(this.scrub.max)) {
      this.pause();
      return;
    }
    requestAnimationFrame((later) => this.tick(later));
  }

  // Shows the time t, with the scene interpolated linearly between two samples.
  private show(t: number): void {
    const run = this.run;
    const end = Number(this.scrub.max);
    this.time = Math.max(0, Math.min(t, end));
    this.scrub.value = String(this.time);
    this.clock.textContent = `${this.time.toFixed(2)} s`;
    this.moments.forEach((moment) => moment(this.time));
    if (run === undefined || run.scene === null || this.stage === undefined) {
      return;
    }
    let [low, high] = [0, run.t.length - 1];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      [low, high] = (run.t[middle] ?? 0) <= this.time ? [middle, high] : [low, middle];
    }
    const [from, to] = [run.t[low] ?? 0, run.t[high] ?? 0];
    const share = to > from ? Math.min(1, Math.max(0, (this.time - from) / (to - from))) : 0;
    const [a, b] = [this.scenes[low], this.scenes[high]];
    if (a === undefined || b === undefined) {
      return;
    }
    for (let index = 0; index < this.between.length; index += 1) {
      const value = a[index] ?? 0;
      this.between[index] = value + share * ((b[index] ?? 0) - value);
    }
    this.stage.move(this.between);
  }

  private async compare(): Promise<void> {
    this.comparison.replaceChildren(element("p", { class: "note" }, "running all methods…"));
    const asked = this.asked() as { until: number };
    try {
      const until = Math.min(asked.until, MAX_COMPARISON_TIME);
      const compared = await this.generator.ask<Case>("compare", { ...asked, until, steps: COMPARISON_STEPS, methods: [] });
      const curves = compared.methods
        .filter((method) => method.kind === "method" && !method.method.endsWith("adaptive"))
        .map((method) => ({
          name: method.method,
          points: method.runs.flatMap((run): [number, number][] => (run.evaluations === null || run.error === null ? [] : [[run.evaluations, run.error]])),
        }));
      this.comparison.replaceChildren(
        precision(`error at t = ${until} against evaluations`, curves),
        element("p", { class: "note" }, `Errors are differences from ${compared.reference}; lower and further left is better.`),
      );
    } catch (error) {
      // A newer run has superseded the comparison.
      this.comparison.replaceChildren(...(error instanceof Superseded ? [] : [element("pre", {}, error instanceof Error ? error.message : String(error))]));
    }
  }
}
