// Tabs with the keyboard interface of ARIA: arrow keys move between them, and one panel is visible.

import { byId } from "./dom";

export class Tabs {
  private readonly tabs: HTMLButtonElement[];

  constructor(list: string, private readonly chosen: (name: string) => void) {
    this.tabs = [...byId(list).querySelectorAll<HTMLButtonElement>("[role=tab]")];
    this.tabs.forEach((tab, index) => {
      tab.onclick = () => this.choose(index, false);
      tab.onkeydown = (event) => {
        const last = this.tabs.length - 1;
        const to = { ArrowRight: index === last ? 0 : index + 1, ArrowLeft: index === 0 ? last : index - 1, Home: 0, End: last }[event.key];
        if (to !== undefined) {
          event.preventDefault();
          this.choose(to, true);
        }
      };
    });
  }

  get current(): string {
    return this.tabs.find((tab) => tab.ariaSelected === "true")?.dataset["name"] ?? "tables";
  }

  private choose(index: number, focus: boolean): void {
    this.tabs.forEach((tab, place) => {
      const on = place === index;
      tab.setAttribute("aria-selected", String(on));
      tab.tabIndex = on ? 0 : -1;
      byId(tab.getAttribute("aria-controls") ?? "").hidden = !on;
    });
    const tab = this.tabs[index];
    if (focus) {
      tab?.focus();
    }
    this.chosen(this.current);
  }
}
