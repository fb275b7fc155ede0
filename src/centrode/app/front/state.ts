// The state of the page: the text of a description, and what the server says of it.
import { batch, computed, effect, signal } from "@preact/signals";
import { changedText } from "./changes";
import { Connection, type Request, SUPERSEDED } from "./connection";
import { History, type KeptStep, type TextFile } from "./history";
import { type Motion, coursesOf, motionOf } from "./motion";
import { type Hello, type Panel, type Problem, type Readiness, type Reading, type Scene, isFrame } from "./protocol";
import { pack, unpack } from "./share";
import { token } from "./token";
import { decimal, language, say, sentence, sentences, units, words } from "./words";

export type Mode = "draw" | "guide" | "edit" | "move";

const query = new URLSearchParams(location.search);
const scheme = location.protocol === "https:" ? "wss" : "ws";
export const connection = new Connection(`${scheme}://${location.host}/socket?token=${encodeURIComponent(token)}`);

export const hello = signal<Hello | null>(null);
export const text = signal("");
export const digest = signal("");
export const scene = signal<Scene | null>(null);
export const problems = signal<Problem[]>([]);
export const readiness = signal<Readiness | null>(null);
export const motion = signal<Motion | null>(null);
export const still = signal<{ message: string; repair?: string } | null>(null); // why there is no motion
export const fileName = signal<string | null>(null);
export const saved = signal<string | null>(null); // the text as the file has it
export const selection = signal<string[]>([]);
export const mode = signal<Mode>("draw");
export const snapping = signal(true);
export const place = signal(0); // of the motion by the drives' laws, between samples
export const playing = signal(false);
export const speed = signal(0); // of the player, as a power of two
export const shows = signal<Record<string, boolean>>({ paths: true, names: true, velocities: false, accelerations: false, grid: true });
export const topic = signal("motion");
export const panels = signal<Map<string, Panel>>(new Map());
export const waits = signal<string | null>(null); // the panel that is computed
export const options = signal<Record<string, Record<string, unknown>>>({});
export const editing = signal(false); // whether the text pane is open
export const said = signal<{ text: string; bad: boolean }>({ text: "", bad: false });
export const steps = signal({ undo: false, redo: false });
export const arrows = signal<import("./protocol").Block | null>(null);
// A motion that the open topic has found is played in place of that by the drives' laws, with a place of its own. While
// somebody draws or drags it rests, and the drawing shows the description.
export const courses = signal<{ key: string; motions: Motion[] }>({ key: "", motions: [] });
export const chosenCourse = signal<Record<string, number>>({}); // topic -> number of its motion
export const coursePlace = signal(0);
export const resting = signal(false);
export const course = computed<Motion | null>(() => {
  const { motions } = courses.value;
  return motions[Math.min(chosenCourse.value[topic.value] ?? 0, motions.length - 1)] ?? null;
});
export const played = computed<Motion | null>(() => course.value ?? motion.value); // by the player
export const playedPlace = computed(() => (course.value ? coursePlace : place)); // the signal of its place
export const drawn = computed(() => (course.value && !resting.value ? { motion: course.value, place: coursePlace } : { motion: motion.value, place }));
export function seek(at: number, of = playedPlace.peek()): void {
  batch(() => {
    playing.value = false;
    resting.value = false;
    of.value = at;
  });
}
export const unsaved = computed(() => saved.value !== null && saved.value !== text.value);

let history = new History("");
// The file of the text that the page shows.
const belongs = (file: TextFile): void => {
  fileName.value = file.name;
  saved.value = file.saved;
};
export const fileNow = (): TextFile => history.file;
export function savedAs(file: TextFile, name: string, content: string): void {
  file.name = name;
  file.saved = content;
  if (file === history.file) belongs(file);
  keep();
}

// What is typed reaches the page a moment later: before it is saved or left, at once.
let typed: () => void = () => undefined;
export const typedBy = (taken: () => void): void => { typed = taken; };
export const takeTyped = (): void => typed();

export const tell = (message: string, bad = false): void => {
  said.value = { text: message, bad };
};
export const refused = (error: { message: string; repair?: string | null }): void =>
  tell(sentences(error.message, error.repair), true);

export const ask = (request: Request, channel: string | null = null): Promise<any> =>
  connection.ask({ language: language.value, ...request }, channel);

// --- texts and what they mean ------------------------------------------------------------------------------------------
let known: string | null = null; // the text that the digest is of
const named = (): { digest: string } | { text: string } => (known === text.value ? { digest: digest.value } : { text: text.value });
function take(answer: Reading): void {
  known = answer.text;
  digest.value = answer.digest;
  connection.know(answer.digest, answer.text);
  scene.value = answer.scene ?? scene.value;
  if (awaited) {
    awaited = false;
    still.value = null;
    fits.value += 1;
  }
  problems.value = answer.problems ?? [];
  readiness.value = answer.readiness ?? null;
  const now = answer.scene;
  if (now) {
    const names = new Set([...now.points, ...now.links, ...now.guides].map((one) => one.name));
    const kept = selection.value.filter((name) => names.has(name));
    if (kept.length !== selection.value.length) selection.value = kept;
  }
}

const settle = (): void => {
  steps.value = { undo: history.undoes, redo: history.redoes };
  keep();
};

let reads = 0;
// Reads a text that has not come from the server: typed, opened, undone.
export async function read(): Promise<void> {
  const own = ++reads, sent = text.value;
  const answer = await ask({ do: "read", text: sent }, "read");
  if (answer === SUPERSEDED || own !== reads) return;
  if (answer.error) {
    refused(answer.error);
    return;
  }
  take({ ...answer, text: sent });
  renew();
}

export function write(next: string, merge = false): void {
  if (next === text.value) return;
  history.put(next, merge);
  text.value = next;
  settle();
  void read();
}

export function load(next: string, name: string | null, onDisk: boolean): void {
  history.put(next, false, { name, saved: onDisk ? next : null });
  text.value = next;
  belongs(history.file);
  selection.value = [];
  opened = true;
  playing.value = false;
  awaited = true;
  tell("");
  settle();
  void read();
}
let opened = false; // whether the next motion is that of another mechanism
let awaited = false; // whether the next scene is another mechanism
export const fits = signal(0); // counts up when the view has to hold everything again

export async function edit(...operations: Record<string, unknown>[]): Promise<Reading | null> {
  reads += 1;
  takeTyped();
  const before = text.value;
  const answer = await ask({ do: "edit", ...named(), operations });
  if (answer.error) {
    refused(answer.error);
    return null;
  }
  takeTyped();
  if (text.value !== before) return null; // typed meanwhile: what is typed stands
  accept(answer);
  return answer;
}

export function accept(answer: Reading): void {
  history.put(answer.text);
  text.value = answer.text;
  take(answer);
  settle();
  const changed = answer.changed?.length ? say("changed", { paths: changedText(answer.changed) }) : "";
  tell(answer.held ? [changed, sentence(answer.held)].filter(Boolean).join(" · ") : changed, Boolean(answer.held));
  renew();
}

function travel(next: string | null): void {
  if (next === null) return;
  text.value = next;
  belongs(history.file);
  tell("");
  settle();
  void read();
}
export const undo = (): void => {
  takeTyped();
  travel(history.undo());
};
export const redo = (): void => {
  takeTyped();
  travel(history.redo());
};

// --- motion and panels -------------------------------------------------------------------------------------------------
export const SAMPLES = 361;

async function renew(): Promise<void> {
  const now = digest.value;
  if (scene.value?.kind === "cam") {
    motion.value = null;
  } else {
    const answer = await ask({ do: "motion", digest: now, samples: SAMPLES }, "motion");
    if (answer === SUPERSEDED || digest.value !== now) return;
    const next = motionOf(answer, now);
    // who looks at the initial position goes on doing so
    if (next && (opened || place.value > next.last || !motion.value || Math.abs(place.value - motion.value.start) < 1e-6)) place.value = next.start;
    opened = opened && !next;
    motion.value = next;
    still.value = next ? null : isFrame(answer) ? null : { message: answer.missing ?? answer.error?.message ?? "", repair: answer.repair ?? answer.error?.repair };
  }
  void show();
}

// Figures are drawn for the width of the panel, so that their letters are as great as those about them.
export const LEAST_SCALE = 1.15, MOST_SCALE = 1.75; // pixels of a point of a figure
export const panelWidth = signal(0); // pixels; none until the panel is there
const WIDTHS = 40, SLACK = 24, WIDEST = 720; // steps of widths; how far one is passed before the next is taken; figures are no wider
export function measurePanel(wide: number): void {
  const step = Math.min(WIDEST, Math.floor(wide / WIDTHS) * WIDTHS), now = panelWidth.peek();
  // a scroll bar that comes and goes changes nothing
  if (wide > 0 && step !== now && (wide < now || wide >= now + WIDTHS + SLACK || !now)) panelWidth.value = step;
}
export const panelKey = (name: string): string => `${language.value} ${digest.value} ${name} ${panelWidth.value} ${JSON.stringify(options.value[name] ?? {})}`;
export const available = (name: string): true | string => scene.value?.topics?.[name] ?? true;

// Asks for the open panel where it is not there yet.
export async function show(): Promise<void> {
  const name = topic.value;
  if (!hello.value || name === "motion" || name === "readiness" || name === "cam" || !digest.value || !panelWidth.value) return;
  const key = panelKey(name);
  if (panels.value.has(key) || waits.value === key || available(name) !== true) return;
  waits.value = key;
  const answer = await ask({ do: "panel", digest: digest.value, topic: name, options: options.value[name] ?? {}, samples: SAMPLES, room: Math.floor(panelWidth.value / LEAST_SCALE) }, "panel");
  if (waits.value === key) waits.value = null;
  if (answer === SUPERSEDED) return;
  const panel: Panel = answer.error ? { topic: name, title: name, blocks: [], missing: answer.error.message, repair: answer.error.repair }
    : isFrame(answer) ? { ...(answer.header as Panel), frame: answer } : answer;
  const next = new Map(panels.value);
  next.set(key, panel);
  while (next.size > 60) next.delete(next.keys().next().value!);
  // motions are large: of few the numbers are kept
  for (const old of [...next].filter(([, one]) => one.frame).slice(0, -MOTIONS_KEPT)) next.delete(old[0]);
  panels.value = next;
}
const MOTIONS_KEPT = 6;

const calm = matchMedia("(prefers-reduced-motion: reduce)");
effect(() => {
  const name = topic.value, key = panelKey(name), panel = panels.value.get(key), before = courses.peek();
  const [was] = before.key.split(" ", 1), own = `${name} ${key}`;
  if (before.key === own || (panel === undefined && was === name && available(name) === true)) return; // what was computed last stays until the new one is there
  const found = { key: panel ? own : "", motions: panel ? coursesOf(panel, digest.peek()) : [] };
  if (!found.motions.length && !before.motions.length) {
    if (before.key !== found.key) courses.value = found;
    return;
  }
  batch(() => {
    courses.value = found;
    if (was === name && before.motions.length && found.motions.length) {
      coursePlace.value = Math.min(coursePlace.peek(), course.peek()?.last ?? 0);
      return;
    }
    coursePlace.value = 0;
    resting.value = false;
    playing.value = Boolean(course.peek()?.course?.loops) && !calm.matches;
  });
});
effect(() => {
  topic.value;
  options.value;
  panelWidth.value;
  language.value;
  queueMicrotask(() => void show());
});

// --- what outlives the window ------------------------------------------------------------------------------------------
const STORE = "centrode.workbench";
let soon = 0;
function keep(): void {
  clearTimeout(soon);
  soon = window.setTimeout(keepNow, 200);
}
export function keepNow(): void {
  takeTyped();
  clearTimeout(soon);
  if (!begun) return; // nothing is shown yet: what an earlier window kept stays
  const state = { text: text.value, name: fileName.value, saved: saved.value, folder: hello.value?.folder, before: history.kept(1_000_000), topic: topic.value };
  // that of the tab comes first when it is loaded again: another tab may write the common one
  for (const store of ["sessionStorage", "localStorage"] as const) {
    try {
      window[store].setItem(STORE, JSON.stringify(state));
    } catch {
      try {
        window[store].setItem(STORE, JSON.stringify({ ...state, before: [] }));
      } catch {
        // a full or a forbidden store: the text is still in the window
      }
    }
  }
}
addEventListener("pagehide", keepNow);
interface Kept {
  text: string;
  name: string | null;
  saved: string | null;
  folder?: string;
  before: KeptStep[];
  topic?: string;
}
const isStep = (step: any): step is KeptStep => typeof step === "string" || typeof step?.text === "string";
function keptState(): Kept | null {
  for (const store of ["sessionStorage", "localStorage"] as const) {
    try {
      const state = JSON.parse(window[store].getItem(STORE) ?? "null");
      if (state && typeof state.text === "string") return { ...state, before: Array.isArray(state.before) ? state.before.filter(isStep) : [] };
    } catch {
      // a forbidden store, or another one's
    }
  }
  return null;
}

// The token of the address stays here: whoever gets the link pastes it into a workbench of his own.
export async function link(): Promise<string> {
  takeTyped();
  return `${location.origin}${location.pathname}#m=${await pack(text.value)}`;
}
export const LINK = /#m=([\w-]*)/;
export async function follow(): Promise<boolean> {
  if (!location.hash.startsWith("#m=")) return false;
  try {
    const shared = await unpack(location.hash.slice(3));
    window.history.replaceState(null, "", location.pathname + location.search);
    load(shared, null, false);
    tell(say("link_read"));
  } catch {
    tell(say("link_damaged"), true);
    return false;
  }
  return true;
}

// --- beginning ---------------------------------------------------------------------------------------------------------
const LANGUAGE = "centrode.language";
export const BLANK = "";
export const SPHERE = `space = "sphere"\ndisplay = { angle = "deg" }\n`;
let begun = false;

async function greet(): Promise<void> {
  let chosen: string | null = null;
  try {
    chosen = localStorage.getItem(LANGUAGE);
  } catch {
    // no store: the server's language
  }
  // what was chosen here, else the language of the command, else that of the browser
  chosen ??= query.get("language") ?? navigator.language.slice(0, 2).toLowerCase();
  const answer = await connection.ask({ do: "hello", language: chosen }, "hello");
  if (answer === SUPERSEDED) return;
  if (answer.error) {
    refused(answer.error);
    return;
  }
  hello.value = answer as Hello;
  words.value = answer.words;
  units.value = answer.units ?? {};
  decimal.value = answer.decimal ?? ".";
  language.value = answer.language ?? chosen ?? "en";
  document.documentElement.lang = language.value;
  if (begun) {
    void read(); // a new server, or another language: what was computed is as good, its words are not
    return;
  }
  begun = true;
  const kept = keptState();
  const file = answer.file as { name: string; text: string } | null;
  if (kept?.topic) topic.value = kept.topic;
  const blank = answer.blank ?? BLANK;
  // a file of another folder may have the same name
  const own = kept !== null && (kept.folder === undefined || kept.folder === answer.folder);
  if (kept) {
    history = new History(kept.text, own ? { name: kept.name, saved: kept.saved } : { name: null, saved: null });
    history.restore(kept.before);
    text.value = kept.text;
    belongs(history.file);
  }
  const drawn = kept !== null && (kept.saved === null ? kept.text !== blank : kept.text !== kept.saved);
  if (await follow()) return;
  if (file && (!kept || !own || kept.name !== file.name || kept.saved !== file.text)) {
    if (!drawn) {
      history = new History(file.text);
      text.value = "";
    }
    load(file.text, file.name, true);
    if (drawn) tell(say("kept_below", { name: kept?.name ?? say("untitled") }));
  } else if (kept) {
    awaited = true;
    settle();
    void read();
  } else {
    history = new History(blank);
    text.value = blank;
    settle();
    void read();
  }
}
connection.onopen = () => void greet();

export function speak(code: string): void {
  try {
    localStorage.setItem(LANGUAGE, code);
  } catch {
    // the choice holds for this window
  }
  language.value = code;
  void greet();
}
