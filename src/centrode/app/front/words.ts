// Sentences come from the server in the reader's language; numbers are spelled as reports spell them.
import { signal } from "@preact/signals";
import { RAISED } from "./typeset";

export { typeset } from "./typeset";

export const words = signal<Record<string, string>>({});
export const language = signal("en");
export const decimal = signal(".");

export type Holes = Record<string, string | number>;
export const fill = (sentence: string, holes: Holes): string =>
  sentence.replace(/\{(\w+)\}/g, (_whole, name: string) => String(holes[name] ?? ""));
export const say = (key: string, holes: Holes = {}): string => fill(words.value[key] ?? key, holes);

const marked = (text: string): string => {
  const [digits = "", power] = text.split("e");
  const minus = digits.startsWith("-") && /[1-9]/.test(digits) ? "−" : "";
  const shown = minus + digits.replace("-", "").replace(".", decimal.value);
  return power ? `${shown}·10${[...String(Number(power))].map((sign) => RAISED[sign]).join("")}` : shown;
};

export const spelled = (value: number | null | undefined, digits = 5): string => {
  if (value === null || value === undefined || !Number.isFinite(value)) return "—";
  const size = Math.abs(value);
  if (size && (size < 1e-4 || size >= 1e7)) return marked(value.toExponential(digits - 1).replace(/\.?0+e/, "e"));
  const text = value.toPrecision(digits);
  return marked((text.includes("e") ? String(Math.round(value)) : text).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, ""));
};

// With as many decimals as the greatest number of its column needs.
export const fixed = (value: number | null | undefined, greatest: number, digits = 5): string => {
  if (value === null || value === undefined || !Number.isFinite(value)) return "—";
  if (greatest && (greatest < 1e-4 || greatest >= 1e7)) return spelled(value, digits);
  const decimals = greatest ? Math.max(0, digits - 1 - Math.floor(Math.log10(greatest))) : 0;
  return marked(value.toFixed(Math.min(9, decimals)));
};

export const tickText = (value: number, step: number): string => {
  const most = Math.max(Math.abs(value), step);
  if (most >= 1e6 || step < 1e-4) return spelled(Math.abs(value) < 1e-9 * step ? 0 : value, 3);
  return marked(value.toFixed(Math.max(0, -Math.floor(Math.log10(step) + 1e-9))));
};

export const units = signal<Record<string, string>>({}); // as the reader's language spells them
export const unitText = (unit?: string | null): string =>
  !unit || unit === "1" ? "" : unit === "deg" ? "°" : (units.value[unit] ?? unit.replace(/[A-Za-z]+/g, (part) => units.value[part] ?? part).replace(/[ *]/g, "·").replace(/\^(\d)/g, (_whole, power: string) => RAISED[power]!));
export const withUnit = (text: string, unit?: string | null): string => {
  const label = unitText(unit);
  return label ? `${text}${label === "°" ? "" : "\u00a0"}${label}` : text;
};

// A clause of the server's as a sentence; what begins with a symbol, a function, a path or a file keeps its letter.
const FORMULA = /^\S*[\d_(=|]|^\S+ =|^\S+\.\S+:|^\p{Script=Greek}/u;
export const sentence = (text: string | null | undefined): string => {
  const plain = (text ?? "").trim();
  return plain && (FORMULA.test(plain) ? plain[0]! : plain[0]!.toLocaleUpperCase()) + plain.slice(1) + (/[.!?…:]$/.test(plain) ? "" : ".");
};
export const sentences = (...texts: (string | null | undefined)[]): string => texts.map(sentence).filter(Boolean).join(" ");
