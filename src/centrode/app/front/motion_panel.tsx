// Curves of the motion: quantities of points and links, with the cursor of the player.
import { type Signal, computed, effect, signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { Chart, type ChartData } from "./chart";
import { Icon } from "./icons";
import type { Motion } from "./motion";
import { motion, place, readiness, scene, seek, selection, still, tell } from "./state";
import { fixed, say, sentence, typeset, unitText, withUnit } from "./words";

interface Course {
  key: string;
  group: string;
  label: string;
  unit: string;
  factor: number;
  lines: { label: string; array: string; thing: number; axis: number | "size" }[];
}

const AXES = ["x", "y", "z"];
const OF_POINT: [string, string, string][] = [["position", "points", ""], ["velocity", "velocities", "/s"], ["acceleration", "accelerations", "/s²"]];
const OF_LINK: [string, string, string, string][] = [["angle", "angles", "φ", ""], ["angular_velocity", "angular_velocities", "ω", "rad/s"], ["angular_acceleration", "angular_accelerations", "ε", "rad/s²"]];
const SYMBOLS: Record<string, string> = { points: "", velocities: "v", accelerations: "a" };

// What may be plotted, point by point and link by link.
const courses = computed<Course[]>(() => {
  const now = motion.value, shown = scene.value;
  if (!now || !shown) return [];
  const display = shown.display, found: Course[] = [];
  for (const point of shown.points) {
    const thing = now.point(point.name);
    if (point.kind === "fixed" || thing < 0) continue;
    for (const [kind, array, rate] of OF_POINT) {
      if (!now.has(array)) continue;
      const length = shown.kind === "sphere" ? { unit: "1", factor: 1 } : display?.length ?? { unit: "m", factor: 1 };
      const symbol = SYMBOLS[array]!;
      const lines: Course["lines"] = AXES.slice(0, now.axes).map((axis, k) => ({ label: symbol ? `${symbol}${axis}(${point.name})` : `${axis}(${point.name})`, array, thing, axis: k }));
      if (symbol) lines.push({ label: `${symbol}(${point.name})`, array, thing, axis: "size" });
      found.push({ key: `point ${point.name} ${kind}`, group: point.name, label: say(`course_${kind}`, { name: point.name }), unit: length.unit === "1" ? (rate ? signed(`1${rate}`) : "") : signed(`${length.unit}${rate}`), factor: length.factor, lines });
    }
  }
  for (const link of shown.links) {
    const thing = now.link(link.name);
    if (thing < 0 || shown.kind === "sphere") continue;
    for (const [kind, array, symbol, unit] of OF_LINK) {
      if (!now.has(array)) continue;
      const angle = display?.angle ?? { unit: "rad", factor: 1 };
      found.push({ key: `link ${link.name} ${kind}`, group: link.name, label: say(`course_${kind}`, { name: link.name }), unit: signed(unit || angle.unit), factor: unit ? 1 : angle.factor, lines: [{ label: `${symbol}(${link.name})`, array, thing, axis: 0 }] });
    }
  }
  return found;
});
export const signed = unitText;

const series = (now: Motion, line: Course["lines"][number], factor: number): Float64Array => {
  const found = new Float64Array(now.samples);
  for (let k = 0; k < now.samples; k += 1) {
    const value = line.axis === "size"
      ? Math.hypot(...Array.from({ length: now.axes }, (_, axis) => now.value(line.array, k, line.thing, axis)))
      : now.value(line.array, k, line.thing, line.axis);
    found[k] = now.reached(k) ? value * factor : NaN;
  }
  return found;
};
const abscissa = computed(() => {
  const now = motion.value;
  return now ? { values: Float64Array.from(now.drive, (value) => value * now.factor), label: now.symbol, unit: signed(now.unit) } : null;
});
const bands = computed(() => {
  const now = motion.value, found: { from: number; to: number }[] = [];
  if (now) for (let k = 0; k < now.samples; k += 1) {
    if (now.reached(k)) continue;
    const last = found[found.length - 1];
    if (last && last.to >= k - 1) last.to = k;
    else found.push({ from: Math.max(0, k - 1), to: k });
    found[found.length - 1]!.to = Math.min(now.last, k + 1);
  }
  return found;
});
const marks = computed(() => {
  const now = motion.value;
  return now ? now.events.flatMap((event) => {
    const at = now.sampleOf(event.drive);
    return at === null ? [] : [{ at, kind: event.kind === "limit" ? "limit" : "change" }];
  }) : [];
});

const chosen = signal<string[]>([]);

// `cursor` is the place of the motion whose samples the curves have; null where they have others.
export function ChartView({ data, cursor = place }: { data: ChartData; cursor?: Signal<number> | null }) {
  const holder = useRef<HTMLDivElement>(null), chart = useRef<Chart | null>(null);
  useEffect(() => {
    const made = new Chart(holder.current!, cursor && ((at) => seek(at, cursor)));
    chart.current = made;
    const stop = effect(() => made.show(cursor?.value ?? 0));
    return () => {
      stop();
      made.end();
      holder.current?.replaceChildren();
    };
  }, []);
  useEffect(() => chart.current?.renew(data), [data]);
  return <div ref={holder} />;
}

function CourseChart({ at }: { at: number }) {
  const key = chosen.value[at]!, course = courses.value.find((one) => one.key === key), now = motion.value, x = abscissa.value;
  const kept = useRef<{ course: Course; now: Motion; data: ChartData } | null>(null);
  if (!course || !now || !x) return null;
  if (kept.current?.course !== course || kept.current.now !== now) {
    kept.current = { course, now, data: { title: course.label, unit: course.unit, x, bands: bands.value, marks: marks.value, lines: course.lines.map((line) => ({ label: line.label, values: series(now, line, course.factor) })) } };
  }
  const groups = [...new Set(courses.value.map((one) => one.group))];
  return (
    <figure class="chart">
      <div class="head">
        <select aria-label={say("quantity")} value={key} onChange={(event) => { chosen.value = chosen.value.map((one, k) => (k === at ? event.currentTarget.value : one)); }}>
          {groups.map((group) => (
            <optgroup label={group}>
              {courses.value.filter((one) => one.group === group).map((one) => <option value={one.key}>{one.label}</option>)}
            </optgroup>
          ))}
        </select>
        <button type="button" class="remove" aria-label={say("remove_curve")} title={say("remove_curve")} onClick={() => { chosen.value = chosen.value.filter((_one, k) => k !== at); }}><Icon name="close" /></button>
      </div>
      <ChartView data={kept.current.data} />
    </figure>
  );
}

// Curves that a selection asks for stand first.
effect(() => {
  const all = courses.value, picked = selection.value[0];
  if (!all.length) return;
  const kept = chosen.peek().filter((key) => all.some((one) => one.key === key));
  if (!kept.length) {
    const free = [...all].reverse().find((one) => one.key.startsWith("point"));
    const name = free?.group ?? "";
    kept.push(...all.filter((one) => one.group === name).slice(0, 2).map((one) => one.key));
  }
  if (picked && !kept.some((key) => key.startsWith(`point ${picked} `) || key.startsWith(`link ${picked} `))) {
    const own = all.filter((one) => one.group === picked).slice(0, 2).map((one) => one.key);
    if (own.length) kept.splice(0, kept.length, ...own);
  }
  if (kept.join("|") !== chosen.peek().join("|")) chosen.value = kept;
});

// Numbers at the cursor: every point and link.
function NumbersTable() {
  const now = motion.value, shown = scene.value;
  if (!now || !shown) return null;
  const sample = Math.round(place.value);
  const rows = courses.value.flatMap((course) => course.lines.map((line) => ({ label: line.label, unit: course.unit, value: (line.axis === "size"
    ? Math.hypot(...Array.from({ length: now.axes }, (_, axis) => now.value(line.array, sample, line.thing, axis)))
    : now.value(line.array, sample, line.thing, line.axis)) * course.factor })));
  return (
    <div class="table scroll long" tabindex={0} role="region" aria-label={say("numbers")}>
      <table>
        <thead><tr><th scope="col">{say("quantity")}</th><th scope="col" class="n">{say("value")}</th></tr></thead>
        <tbody>{rows.map((row) => <tr><th scope="row">{row.label}</th><td class="n">{withUnit(fixed(row.value, Math.max(1, Math.abs(row.value))), row.unit)}</td></tr>)}</tbody>
      </table>
    </div>
  );
}
const numbersOpen = signal(false);

export function MotionPanel() {
  const now = motion.value;
  if (!now && (readiness.value?.missing.length || readiness.value?.loose.length)) return <Missing message={say("no_motion")} />; // why stands there
  if (!now) return <Missing message={still.value?.message || say("no_motion")} repair={still.value?.repair ?? ""} />;
  return (
    <>
      {now.limits.map((one) => <p class="limit">{sentence(one)}</p>)}
      <div class="charts">{chosen.value.map((_key, k) => <CourseChart key={k} at={k} />)}</div>
      <div class="buttons">
        <button type="button" onClick={() => {
          const next = courses.value.find((one) => !chosen.value.includes(one.key));
          if (next && chosen.value.length < 12) chosen.value = [...chosen.value, next.key];
        }}>{say("add_curve")}</button>
        <button type="button" onClick={() => void copyTable()}>{say("copy_csv")}</button>
      </div>
      <details class="numbers" open={numbersOpen.value} onToggle={(event) => { numbersOpen.value = event.currentTarget.open; }}>
        <summary>{say("numbers")}</summary>
        {numbersOpen.value && <NumbersTable />}
      </details>
    </>
  );
}

export function Missing({ message, repair }: { message: string; repair?: string | null }) {
  return <p class="missing"><b>{typeset(sentence(message))}</b>{repair ? ` ${typeset(sentence(repair))}` : ""}</p>;
}

async function copyTable(): Promise<void> {
  const now = motion.value, x = abscissa.value;
  if (!now || !x) return;
  const columns = courses.value.flatMap((course) => course.lines.map((line) => ({ head: `${line.label} [${course.unit}]`, values: series(now, line, course.factor) })));
  const rows = [[`${x.label} [${x.unit}]`, ...columns.map((one) => one.head)].map((one) => `"${one.replaceAll('"', '""')}"`).join(",")];
  for (let k = 0; k < now.samples; k += 1) rows.push([x.values[k]!, ...columns.map((one) => one.values[k]!)].map((value) => (Number.isFinite(value) ? Number(value.toPrecision(7)) : "")).join(","));
  await copyText(`${rows.join("\n")}\n`, say("table_copied"));
}

export async function copyText(text: string, done: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
    tell(done);
  } catch {
    byHand.value = text;
  }
}
export const byHand = signal<string | null>(null); // what the browser did not let the page copy
