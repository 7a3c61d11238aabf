// Formulas, typeset by KaTeX. Very long ones are typeset on request.

import katex from "katex";
import { element } from "./dom";

// Number of characters of LaTeX above which a formula is typeset on request.
const MAX_LENGTH_AT_ONCE = 1500;

export function formula(latex: string): HTMLElement {
  if (latex.length <= MAX_LENGTH_AT_ONCE) {
    return typeset(latex);
  }
  const button = element("button", { class: "long", type: "button" }, `show a formula of ${latex.length.toLocaleString("en")} characters`);
  button.onclick = () => button.replaceWith(typeset(latex));
  return button;
}

// Cache of typeset formulas, since most stay the same while the text is edited; the oldest are removed first.
const known = new Map<string, HTMLElement>();
const MAX_CACHED = 3000;

function typeset(latex: string): HTMLElement {
  let span = known.get(latex);
  if (span === undefined) {
    span = element("span", { class: "formula" });
    katex.render(latex, span, { throwOnError: false, strict: "ignore" });
    known.set(latex, span);
    if (known.size > MAX_CACHED) {
      known.delete(known.keys().next().value ?? "");
    }
  }
  return span.cloneNode(true) as HTMLElement;
}
