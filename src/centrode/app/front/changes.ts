// What an edit has changed, as the line under the drawing tells it: the paths of the description that differ.
const MOST = 4;
const VECTORS = 3; // names of a path from which a number behind them counts coordinates: of a list of tables it names one
const ENTRY: Record<string, number> = { frame: 3 }; // names of a path of one element, where they are not two

// Each element once: a vector for its coordinates, an element for several of its keys.
export function changedElements(paths: readonly string[]): string[] {
  const whole = paths.map((path) => path.split(".")).map((names) => (names.length >= VECTORS && /^\d+$/.test(names.at(-1)!) ? names.slice(0, -1) : names));
  const told = new Map<string, string>(); // element -> what is told of it
  for (const names of whole) {
    const path = names.join("."), element = names.slice(0, ENTRY[names[0]!] ?? 2).join(".");
    const before = told.get(element);
    told.set(element, before === undefined || before === path ? path : element);
  }
  return [...told.values()];
}

export function changedText(paths: readonly string[]): string {
  const told = changedElements(paths);
  return told.slice(0, MOST).join(", ") + (told.length > MOST ? ", …" : "");
}
