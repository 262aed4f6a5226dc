// Colors that people tell apart who see few of them (after the palette of Okabe and Ito, and of viridis).

/** Of objects. */
const OBJECTS = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#56b4e9", "#f0e442"];

/** @param {number} id */
export const ofObject = (id) => OBJECTS[((id % OBJECTS.length) + OBJECTS.length) % OBJECTS.length];

/** From weak to strong. */
const SCALE = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];

/**
 * The color of a strength from 0 to 1.
 * @param {number} share
 */
export function ofStrength(share) {
  const at = Math.min(Math.max(share, 0), 1) * (SCALE.length - 1);
  const i = Math.min(Math.floor(at), SCALE.length - 2);
  const mix = SCALE[i].map((c, k) => Math.round(c + (at - i) * (SCALE[i + 1][k] - c)));
  return `rgb(${mix.join(" ")})`;
}

/**
 * The value of a color of the page's style.
 * @param {string} name
 */
export const ofPage = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
