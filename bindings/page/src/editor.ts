// The text editor, which underlines the generator's errors and warnings.

import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { bracketMatching } from "@codemirror/language";
import { type Diagnostic, setDiagnostics, lintGutter, lintKeymap } from "@codemirror/lint";
import { searchKeymap } from "@codemirror/search";
import { EditorState } from "@codemirror/state";
import {
  EditorView,
  drawSelection,
  highlightActiveLine,
  keymap,
  lineNumbers,
} from "@codemirror/view";
import type { Mark } from "./answers";
import { descriptions } from "./language";

const look = EditorView.theme({
  "&": { height: "100%", fontSize: "var(--code)", backgroundColor: "transparent", color: "var(--text)" },
  ".cm-scroller": { fontFamily: "var(--mono)", lineHeight: "1.5" },
  ".cm-content": { caretColor: "var(--text)" },
  ".cm-cursor": { borderLeftColor: "var(--text)" },
  ".cm-gutters": { backgroundColor: "transparent", color: "var(--faint)", border: "none" },
  ".cm-activeLine": { backgroundColor: "var(--line)" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": {
    backgroundColor: "var(--selection)",
  },
  ".cm-tooltip": {
    backgroundColor: "var(--panel)",
    color: "var(--text)",
    border: "1px solid var(--border)",
    maxWidth: "36rem",
    whiteSpace: "pre-wrap",
  },
});

export class Editor {
  readonly view: EditorView;

  constructor(parent: HTMLElement, text: string, changed: (text: string) => void) {
    this.view = new EditorView({
      parent,
      state: EditorState.create({
        doc: text,
        extensions: [
          lineNumbers(),
          history(),
          drawSelection(),
          highlightActiveLine(),
          bracketMatching(),
          lintGutter(),
          EditorView.contentAttributes.of({ "aria-label": "Description of the mechanism" }),
          keymap.of([
            // Tab indents; after Escape it leaves the editor, as is usual in CodeMirror.
            indentWithTab,
            ...defaultKeymap,
            ...historyKeymap,
            ...searchKeymap,
            ...lintKeymap,
          ]),
          descriptions,
          look,
          EditorView.updateListener.of((update) => {
            if (update.docChanged) {
              changed(update.state.doc.toString());
            }
          }),
        ],
      }),
    });
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  set text(text: string) {
    this.view.dispatch({
      changes: { from: 0, to: this.view.state.doc.length, insert: text },
      selection: { anchor: 0 },
      scrollIntoView: true,
    });
  }

  // Underlines errors and warnings; those without a place are shown at the start of the text.
  mark(marks: Mark[]): void {
    const end = this.view.state.doc.length;
    const placed = marks.map((mark): Diagnostic => {
      const [from, to] = (mark.range ?? [0, 0]).map((at) => Math.min(at, end)) as [number, number];
      const notes = mark.notes.map((note) => `\nnote: ${note.label}`).join("");
      const help = mark.help === null ? "" : `\nhelp: ${mark.help}`;
      return { from, to, severity: mark.severity, message: mark.message + notes + help };
    });
    this.view.dispatch(setDiagnostics(this.view.state, placed));
  }

  // Moves the cursor to an offset in the text.
  goTo(place: number): void {
    this.view.dispatch({ selection: { anchor: Math.min(place, this.view.state.doc.length) }, scrollIntoView: true });
    this.view.focus();
  }
}
