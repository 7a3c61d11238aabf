// Tables of φ, A, Y, γ, M, Γ: entries with the same value share a row, as in the paper; entries not shown are zero.

import type { Definition, Indexed, Table, Tables } from "./answers";
import { element } from "./dom";
import { formula } from "./formulas";

// Number of rows that are shown at first; more are shown on request.
const ROWS_AT_FIRST = 40;

// Names of the tables in the order of the requests: cheap ones first.
export const ALL = ["phi", "A", "Y", "gamma", "M", "Gamma"];

// Whether a table is derived only on request, since its entries would fill pages.
export function isDerivedOnRequest(name: string, velocities: number): boolean {
  return velocities > ({ M: 8, Gamma: 5 }[name] ?? Infinity);
}

// Placeholder of a table that is derived on request, with a button that derives it.
export function placeholder(name: string, velocities: number, derive: () => void): HTMLElement {
  const symbol = formula(name === "M" ? "M" : "\\Gamma");
  const entries = name === "M" ? velocities ** 2 : velocities ** 3;
  const button = element("button", { type: "button" }, `derive ${entries.toLocaleString("en")} entries (slow)`);
  button.onclick = () => {
    button.disabled = true;
    button.textContent = "deriving…";
    derive();
  };
  return element("section", { class: "table", "data-asked": name }, element("h3", {}, symbol, button));
}

export function heading(tables: Tables): HTMLElement {
  const list = (names: string[]) => `(${names.join(",\\,")})`;
  return element(
    "p",
    { class: "symbols" },
    formula(`x = ${list(tables.coordinates)}`),
    element("br"),
    formula(`\\xi = ${list(tables.velocities)}`),
  );
}

export function section(table: Table): HTMLElement {
  const count = `${table.nonzero} of ${table.size} entries ${table.nonzero === 1 ? "is" : "are"} nonzero`;
  const body = element("section", { class: "table", "data-table": table.name });
  body.append(
    element("h3", {}, formula(table.symbol), ` ${table.title}`, element("small", {}, count)),
    ...definitions(table.before),
  );
  if (table.groups.length > 0) {
    const head = element(
      "tr",
      {},
      element("th", { scope: "col" }, "value of ", formula(table.symbol)),
      element("th", { scope: "col" }, "entries equal to it"),
      element("th", { scope: "col" }, "entries equal to its negative"),
    );
    body.append(
      rows(
        "grouped",
        head,
        table.groups.map((group) => () =>
          element(
            "tr",
            {},
            element("td", {}, formula(group.value)),
            element("td", {}, ...indices(group.plus, group.value, "")),
            element("td", {}, ...indices(group.minus, group.value, "-")),
          ),
        ),
      ),
    );
  }
  if (table.entries.length > 0) {
    body.append(
      rows(
        "listed",
        null,
        table.entries.map((entry) => () =>
          element("tr", {}, element("td", {}, formula(`${entry.left} = ${entry.value}`)), element("td", {}, entry.reads)),
        ),
      ),
    );
  }
  body.append(...definitions(table.after));
  return body;
}

// The indices of entries; each shows its equation on hover or focus.
function indices(list: Indexed[], value: string, sign: string): Node[] {
  return list.map((entry) => {
    const equation = sign === "" ? `${entry.left} = ${value}` : `${entry.left} = -\\left(${value}\\right)`;
    const chip = element("button", { class: "index", type: "button", "aria-label": `entry ${entry.index}` }, entry.index);
    const tip = element("span", { class: "tip", role: "tooltip" });
    const show = () => {
      if (tip.childNodes.length === 0) {
        tip.append(formula(equation));
      }
      chip.append(tip);
      const over = tip.getBoundingClientRect().right - document.documentElement.clientWidth + 12;
      tip.style.translate = over > 0 ? `${-over}px` : "";
    };
    chip.onpointerenter = show;
    chip.onfocus = show;
    chip.onpointerleave = () => tip.remove();
    chip.onblur = () => tip.remove();
    return chip;
  });
}

function definitions(list: Definition[]): Node[] {
  if (list.length === 0) {
    return [];
  }
  const one = (definition: Definition) => () =>
    element("tr", {}, element("td", {}, formula(`${definition.left} = ${definition.value}`)));
  return [rows("listed", null, list.map(one))];
}

// A table with a button that shows more rows.
function rows(kind: string, head: HTMLElement | null, make: (() => HTMLElement)[]): HTMLElement {
  const body = element("tbody", {}, ...make.slice(0, ROWS_AT_FIRST).map((row) => row()));
  const table = element("table", { class: kind }, head === null ? null : element("thead", {}, head), body);
  const scroll = element("div", { class: "scroll" }, table);
  let shown = ROWS_AT_FIRST;
  if (make.length > shown) {
    const more = element("button", { type: "button", class: "more" });
    const label = () => (more.textContent = `show ${Math.min(make.length - shown, 10 * ROWS_AT_FIRST)} of ${make.length - shown} more rows`);
    more.onclick = () => {
      body.append(...make.slice(shown, shown + 10 * ROWS_AT_FIRST).map((row) => row()));
      shown += 10 * ROWS_AT_FIRST;
      if (shown >= make.length) {
        more.remove();
      } else {
        label();
      }
    };
    label();
    scroll.append(more);
  }
  return scroll;
}
