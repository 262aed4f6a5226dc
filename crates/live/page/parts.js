// Small parts of the page: buttons, sliders, checks, dialogs.

/**
 * An element with its properties and what is in it.
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} name
 * @param {Record<string, any>} [properties]
 * @param {...(Node | string)} inside
 * @returns {HTMLElementTagNameMap[K]}
 */
export function make(name, properties = {}, ...inside) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key in made && !key.startsWith("aria")) /** @type {any} */ (made)[key] = value;
    else made.setAttribute(key, value);
  }
  made.append(...inside);
  return made;
}

/**
 * A value that is set on a scale of powers of ten, with a field for the number beside it.
 */
export class Slider {
  /**
   * @param {HTMLElement} parent
   * @param {{label: string, unit: string, value: number, set: (value: number, end: boolean) => void}} what
   */
  constructor(parent, { label, unit, value, set }) {
    this.set = set;
    this.range = make("input", { type: "range", min: "0", max: "1000", step: "1", "aria-label": `${label}, ${unit}` });
    this.field = make("input", { type: "number", step: "any", min: "0", "aria-label": `${label}, ${unit}, as a number` });
    this.middle = value > 0 ? value : 1;
    const words = make("label", {}, label + " ", make("span", { className: "unit" }, unit));
    this.row = make("div", { className: "slider" }, words, this.range, this.field);
    parent.append(this.row);
    this.range.oninput = () => this.tell(this.of(Number(this.range.value)), false);
    this.range.onchange = () => this.tell(this.of(Number(this.range.value)), true);
    this.field.onchange = () => {
      const typed = Number(this.field.value);
      if (this.field.value !== "" && Number.isFinite(typed)) this.tell(typed, true);
    };
    this.show(value);
  }

  /**
   * The value at a place of the slider: 0 at its left end, then over six powers of ten about the middle.
   * @param {number} at
   */
  of(at) {
    return at === 0 ? 0 : Number((this.middle * 10 ** ((6 * (at - 500)) / 1000)).toPrecision(3));
  }

  /**
   * @param {number} value
   * @param {boolean} end
   */
  tell(value, end) {
    this.field.value = String(value);
    this.set(value, end);
  }

  /** @param {number} value */
  show(value) {
    if (document.activeElement === this.field) return;
    this.field.value = String(Number(value.toPrecision(4)));
    if (document.activeElement === this.range) return;
    if (value > 0) {
      const at = 500 + (1000 / 6) * Math.log10(value / this.middle);
      if (at < 1 || at > 1000) this.middle = value;
      this.range.value = String(at < 1 || at > 1000 ? 500 : Math.round(at));
    } else this.range.value = "0";
  }
}

/**
 * A check with its words.
 * @param {HTMLElement} parent
 * @param {string} words
 * @param {boolean} on
 * @param {(on: boolean) => void} set
 */
export function check(parent, words, on, set) {
  const box = make("input", { type: "checkbox", checked: on });
  box.onchange = () => set(box.checked);
  const label = make("label", {}, box, " " + words);
  parent.append(label);
  return box;
}

/**
 * Show a dialog.
 * @param {string} title
 * @param {...(Node | string)} inside
 * @returns {HTMLDialogElement}
 */
export function dialog(title, ...inside) {
  const box = /** @type {HTMLDialogElement} */ (document.getElementById("dialog"));
  const close = make("button", { textContent: "Close", style: "float: right" });
  close.onclick = () => box.close();
  box.replaceChildren(close, make("h2", {}, title), ...inside);
  if (!box.open) box.showModal();
  return box;
}
