// The page: the description on the left, the results of the generator on the right.

import type { Advice, Checked, Imported, Mark, Operations, System, Tables } from "./answers";
import { byId, element } from "./dom";
import { Editor } from "./editor";
import { Superseded, Generator } from "./generator";
import { joinStreams } from "./instructions";
import { toFragment, fromFragment } from "./link";
import { Motion } from "./motion";
import * as reports from "./reports";
import * as tables from "./tables";
import { Tabs } from "./tabs";

interface Example {
  name: string;
  text: string;
  until: number;
}

// Time after the last change before the text is read (ms), so that a paste or a held key is read once.
const DEBOUNCE_MS = 8;

class Page {
  private readonly editor: Editor;
  private readonly tabs: Tabs;
  private resting: number | undefined;
  // Number of the current text, so that answers about older ones are ignored.
  private age = 0;
  private system: System | null = null;
  // Whether any text so far had no errors.
  private derived = false;
  // Panels that show the current text.
  private readonly shown = new Set<string>();
  private name = "system.eom";
  // The last description generated from a robot, with the warnings of the import.
  private imported = { text: "", said: "" };
  readonly motion: Motion;

  constructor(
    private readonly generator: Generator,
    examples: Example[],
    text: string,
  ) {
    this.motion = new Motion(byId("panel-motion"), generator);
    this.tabs = new Tabs("tabs", () => this.show());
    this.editor = new Editor(byId("editor"), text, () => this.changed());
    this.examples(examples);
    this.files();
    byId("link").onclick = () => this.copyLink();
    window.addEventListener("hashchange", () => this.followLink());
    void this.read();
  }

  get text(): string {
    return this.editor.text;
  }

  private changed(): void {
    clearTimeout(this.resting);
    this.generator.drop();
    document.body.dataset["answered"] = "";
    const begin = performance.now();
    this.resting = window.setTimeout(() => void this.read(begin), DEBOUNCE_MS);
  }

  // Reads the text, then fills the active panel.
  private async read(begin = performance.now()): Promise<void> {
    const age = ++this.age;
    document.body.dataset["answered"] = "";
    const text = this.editor.text;
    this.status("deriving…");
    try {
      const opened = await this.generator.open(text, this.name);
      if (age !== this.age) {
        return;
      }
      this.editor.mark(opened.marks);
      const imported = text === this.imported.text ? this.imported.said : "";
      this.say(opened.marks, opened.said.trim() === "" ? imported : opened.said);
      this.system = opened.system;
      this.shown.clear();
      this.stale(opened.system === null);
      void this.keep(text);
      if (opened.system === null) {
        const errors = Math.max(1, opened.marks.filter((mark) => mark.severity === "error").length);
        document.body.dataset["answered"] = "yes";
        const below = this.derived ? "; the results below belong to the last text without errors" : "";
        this.status(`${errors} error${errors === 1 ? "" : "s"} in the description${below}`, true);
        return;
      }
      this.derived = true;
      await this.show();
      this.status(`${opened.system.name}, in ${Math.round(performance.now() - begin)} ms`);
      document.body.dataset["latency"] = String(performance.now() - begin);
      document.body.dataset["answered"] = "yes";
    } catch (error) {
      this.failed(error);
    }
  }

  // Fills the active panel, unless it already shows the current text.
  private async show(): Promise<void> {
    const name = this.tabs.current;
    const system = this.system;
    if (system === null || this.shown.has(name)) {
      return;
    }
    this.shown.add(name);
    const age = this.age;
    const panel = byId(`panel-${name}`);
    const fill = {
      tables: () => this.showTables(panel, age),
      identities: async () => panel.replaceChildren(...reports.identities(await this.generator.ask<Checked>("check"))),
      operations: () => this.showOperations(panel),
      code: () => this.showCode(panel),
      motion: () => this.motion.of(system),
    }[name];
    try {
      await fill?.();
      document.body.dataset[name] = String(age);
    } catch (error) {
      this.shown.delete(name);
      if (!(error instanceof Superseded)) {
        panel.replaceChildren(element("pre", {}, error instanceof Error ? error.message : String(error)));
      }
    }
  }

  private async showTables(panel: HTMLElement, age: number): Promise<void> {
    const velocities = this.system?.velocities.entries.length ?? 0;
    const derived = async (name: string) => {
      const answer = await this.generator.ask<Tables>("tables", { of: [name] });
      return { answer, shown: answer.tables.filter((table) => table.nonzero > 0 || table.name === "gamma") };
    };
    // Each table is derived while the one before it is typeset.
    const coming = tables.ALL.map((name) => ({ name, table: tables.isDerivedOnRequest(name, velocities) ? null : derived(name) }));
    coming.forEach(({ table }) => table?.catch(() => {}));
    let begun = false;
    for (const { name, table } of coming) {
      if (table === null) {
        const place = tables.placeholder(name, velocities, () => {
          derived(name).then(({ shown }) => place.replaceWith(...shown.map(tables.section)), (error: unknown) => this.failed(error));
        });
        panel.append(place);
        continue;
      }
      const { answer, shown } = await table;
      if (age !== this.age) {
        return;
      }
      if (!begun) {
        begun = true;
        panel.replaceChildren(tables.heading(answer));
      }
      panel.append(...shown.map(tables.section));
    }
  }

  private async showOperations(panel: HTMLElement): Promise<void> {
    const counted = await this.generator.ask<Operations>("operations");
    panel.replaceChildren(...reports.operations(counted), element("h3", {}, "Other velocities"));
    const below = element("div", {}, "comparing…");
    panel.append(below);
    try {
      below.replaceChildren(...reports.advice(await this.generator.ask<Advice>("advice")));
    } catch (error) {
      if (error instanceof Superseded) {
        throw error;
      }
      below.replaceChildren(element("pre", {}, error instanceof Error ? error.message : String(error)));
    }
  }

  private async showCode(panel: HTMLElement): Promise<void> {
    const rust = await this.generator.ask<string>("rust", { name: this.name });
    const c = await this.generator.ask<{ header: string; source: string }>("c", { name: this.name });
    const stem = this.name.replace(/\.eom$/, "");
    panel.replaceChildren(
      reports.code(`Rust: ${stem}.rs`, rust),
      reports.code(`C99: ${stem}.h`, c.header),
      reports.code(`C99: ${stem}.c`, c.source),
    );
  }

  // Lists errors and warnings below the text, as buttons that move the cursor to their places.
  private say(marks: Mark[], said: string): void {
    const list: Node[] = marks.map((mark) => {
      const line = mark.range === null ? null : this.editor.view.state.doc.lineAt(Math.min(mark.range[0], this.editor.view.state.doc.length));
      // Columns count characters, like the command line; some characters are two UTF-16 units.
      const before = line === null || mark.range === null ? "" : line.text.slice(0, mark.range[0] - line.from);
      const place = line === null ? "" : ` at ${line.number}:${[...before].length + 1}`;
      const button = element(
        "button",
        { type: "button", class: `message ${mark.severity}` },
        element("b", {}, mark.severity + place),
        ` ${mark.message}`,
        mark.help === null ? null : element("small", {}, mark.help),
      );
      button.onclick = () => this.editor.goTo(mark.range?.[0] ?? 0);
      return button;
    });
    byId("messages").replaceChildren(...(list.length === 0 && said.trim() !== "" ? [element("pre", {}, said)] : list));
  }

  private status(text: string, bad = false): void {
    const status = byId("status");
    status.textContent = text;
    status.classList.toggle("bad", bad);
  }

  private stale(stale: boolean): void {
    for (const panel of document.querySelectorAll("[role=tabpanel]")) {
      panel.classList.toggle("stale", stale);
    }
  }

  private failed(error: unknown): void {
    if (!(error instanceof Superseded)) {
      this.status(error instanceof Error ? error.message : String(error), true);
    }
  }

  private examples(examples: Example[]): void {
    const select = byId<HTMLSelectElement>("examples");
    select.append(element("option", { value: "" }, "choose…"));
    examples.forEach(({ name }, index) => {
      select.append(element("option", { value: String(index) }, name.replaceAll("_", " ")));
    });
    select.onchange = () => {
      const example = examples[Number(select.value)];
      if (select.value !== "" && example !== undefined) {
        this.name = `${example.name}.eom`;
        this.motion.lasts(example.until);
        this.editor.text = example.text;
      }
    };
  }

  // Accepts files by the button, or dropped onto the editor.
  private files(): void {
    const picker = byId<HTMLInputElement>("file");
    byId("robot").onclick = () => picker.click();
    picker.onchange = () => {
      const file = picker.files?.[0];
      picker.value = "";
      if (file !== undefined) {
        void this.take(file);
      }
    };
    const target = byId("editor");
    const over = (event: DragEvent) => {
      if (event.dataTransfer?.types.includes("Files") === true) {
        event.preventDefault();
        target.classList.add("over");
      }
    };
    target.addEventListener("dragover", over, true);
    target.addEventListener("dragleave", () => target.classList.remove("over"), true);
    target.addEventListener(
      "drop",
      (event) => {
        target.classList.remove("over");
        const file = event.dataTransfer?.files[0];
        if (file !== undefined) {
          event.preventDefault();
          event.stopPropagation();
          void this.take(file);
        }
      },
      true,
    );
  }

  // Opens a description, or converts a robot in URDF to one.
  private async take(file: File): Promise<void> {
    const text = await decoded(file);
    const stem = file.name.replace(/\.[^.]*$/, "");
    if (!text.trimStart().startsWith("<")) {
      this.name = `${stem}.eom`;
      this.editor.text = text;
      return;
    }
    const floating = byId<HTMLInputElement>("floating").checked;
    this.generator.drop();
    try {
      const imported = await this.generator.ask<Imported>("import", { text, name: file.name, floating });
      if (imported.text === null) {
        this.say([], imported.said);
        this.status(`${file.name} cannot be read as a robot`, true);
        return;
      }
      this.name = `${stem}.eom`;
      this.imported = { text: imported.text, said: imported.said };
      this.editor.text = imported.text;
    } catch (error) {
      this.failed(error);
    }
  }

  private async keep(text: string): Promise<void> {
    const hash = `#${await toFragment(text)}`;
    if (text === this.editor.text && hash !== location.hash) {
      history.replaceState(null, "", hash);
    }
  }

  private async followLink(): Promise<void> {
    const text = await fromFragment(location.hash.slice(1));
    if (text !== undefined && text !== this.editor.text) {
      this.editor.text = text;
    }
  }

  private async copyLink(): Promise<void> {
    await this.keep(this.editor.text);
    try {
      await navigator.clipboard.writeText(location.href);
      this.status("link copied; it contains the whole text");
    } catch {
      this.status("copy the address of this page; it contains the whole text");
    }
  }
}

// Decodes a file: UTF-16 with a byte order mark, the encoding of an XML declaration, otherwise UTF-8.
async function decoded(file: File): Promise<string> {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const start = new TextDecoder("latin1").decode(bytes.subarray(0, 200));
  const declared = /<\?xml[^>]*encoding\s*=\s*["']([^"']+)/.exec(start)?.[1];
  // A declaration of UTF-16 that is itself in single bytes is wrong: the file was converted.
  const narrow = declared?.toLowerCase().startsWith("utf-16") === true ? undefined : declared;
  const wide = start.startsWith("\u00ff\u00fe") ? "utf-16le" : start.startsWith("\u00fe\u00ff") ? "utf-16be" : undefined;
  try {
    return new TextDecoder(wide ?? narrow ?? "utf-8").decode(bytes);
  } catch {
    return new TextDecoder().decode(bytes);
  }
}

// Unpacks a part of the file; defined in `bindings/page/src/loader.ts`.
declare const hamelPart: (id: string) => Uint8Array<ArrayBuffer>;

async function begin(): Promise<void> {
  const module = await WebAssembly.compile(joinStreams(hamelPart("module")));
  const examples = JSON.parse(new TextDecoder().decode(hamelPart("examples-packed"))) as Example[];
  const worker = byId("worker").textContent ?? "";
  const linked = location.hash.length > 1 ? await fromFragment(location.hash.slice(1)) : undefined;
  const first = examples.find((example) => example.name === "heavy_top");
  const generator = new Generator(module, worker);
  const page = new Page(generator, examples, linked ?? first?.text ?? "");
  // For the console and tests.
  Object.assign(globalThis, { hamel: generator, hamelText: () => page.text, hamelMotion: page.motion });
  document.body.dataset["ready"] = "yes";
}

begin().catch((error: unknown) => {
  byId("status").textContent = `The page could not start: ${String(error)}. It needs a browser with WebAssembly and DecompressionStream.`;
});
