// A cam: its profile under the follower, and its segments as fields, with the profile following every change.
import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { camPicture } from "./cam_picture";
import { Icon } from "./icons";
import { ChartView, Missing, signed } from "./motion_panel";
import type { CamScene, Segment } from "./protocol";
import { edit, place, problems, scene } from "./state";
import { say } from "./words";

const PRIMES = { lift: "", velocity: "′", acceleration: "″" };
const QUANTITIES = ["lift", "velocity", "acceleration"] as const;

// The cam turns under its follower; the line above it is the follower's place at that angle.
export function CamStage() {
  const holder = useRef<HTMLDivElement>(null), cam = scene.value?.cam, at = place.value;
  const box = signalSize(holder);
  useEffect(() => {
    const element = holder.current;
    if (!element || !cam) return;
    element.replaceChildren(camPicture(cam, at, box.wide, box.high, `${say("cam_picture")}: ${scene.value?.title ?? ""}`));
  }, [cam, at, box.wide, box.high]);
  return <div class="cam-stage" ref={holder} />;
}

const sizes = signal({ wide: 600, high: 500 });
function signalSize(holder: { current: HTMLElement | null }): { wide: number; high: number } {
  useEffect(() => {
    const watch = new ResizeObserver(([entry]) => {
      const { width, height } = entry!.contentRect;
      if (Math.abs(width - sizes.value.wide) > 2 || Math.abs(height - sizes.value.high) > 2) sizes.value = { wide: width, high: height };
    });
    watch.observe(holder.current!);
    return () => watch.disconnect();
  }, []);
  return sizes.value;
}

// What the player goes through: angles of the cam, or of what leads a roller around it.
export const camAngles = (cam: CamScene | undefined): number[] => cam?.carrier ?? cam?.displacement?.angle ?? [];
export const camSamples = (cam: CamScene | undefined): number => Math.max(0, camAngles(cam).length - 1);

function Field({ label, value, unit, path, wide }: { label: string; value: string; unit?: string; path: string; wide?: boolean }) {
  const wrong = problems.value.find((problem) => problem.path === path);
  return (
    <label class={wide ? "field wide" : "field"}>
      <span>{label}</span>
      <input type="text" inputMode="decimal" value={value} aria-invalid={Boolean(wrong)} onChange={(event) => void edit({ do: "set", path, value: event.currentTarget.value })} />
      {unit && <span class="unit">{signed(unit)}</span>}
    </label>
  );
}

function SegmentRow({ segment, number, last }: { segment: Segment; number: number; last: boolean }) {
  const words: Record<string, string> = { angle: "segment_angle", share: "segment_share", time: "segment_time", to: "segment_to" };
  const key = (path: string): string => path.slice(segment.path.length + 1);
  const fields = (scene.value?.dimensions ?? []).filter((one) => one.of === segment.path && words[key(one.path)]);
  return (
    <li class="segment">
      <span class="number">{number}</span>
      {fields.map((one) => <Field label={say(words[key(one.path)]!)} value={one.shown} unit={one.unit} path={one.path} key={one.path} />)}
      <label class="field wide"><span>{say("segment_law")}</span>
        <select value={segment.law ?? ""} onChange={(event) => void edit({ do: "set_curve", segment: number - 1, curve: event.currentTarget.value })}>
          {[...new Set([segment.law ?? "", ...(segment.laws ?? [])])].filter(Boolean).map((law) => <option value={law}>{segment.names?.[law] ?? law}</option>)}
        </select>
      </label>
      <span class="ends">
        <button type="button" class="plain" data-do="add-segment" aria-label={say("segment_add", { number })} title={say("segment_add", { number })}
          onClick={() => void edit({ do: "add_segment", after: number - 1 })}><Icon name="plus" /></button>
        <button type="button" class="plain" data-do="delete-segment" aria-label={say("segment_delete", { number })} title={say("segment_delete", { number })} disabled={last}
          onClick={() => void edit({ do: "delete_segment", segment: number - 1 })}><Icon name="close" /></button>
      </span>
    </li>
  );
}

export function CamPanel() {
  const now = scene.value, cam = now?.cam, course = cam?.displacement;
  if (!cam) return <Missing message={problems.value[0]?.message ?? say("no_cam")} repair={problems.value[0]?.repair} />;
  // what is wrong stands above its fields: there it is corrected
  const wrong = cam.missing ? cam : problems.value[0] ? { missing: problems.value[0].message, repair: problems.value[0].repair ?? undefined } : !cam.profile.length && !course ? { missing: say("no_cam"), repair: undefined } : null;
  const angle = now?.display?.angle ?? { unit: "rad", factor: 1 }, lift = course?.unit === "rad" ? angle : now?.display?.length ?? { unit: "m", factor: 1 };
  const x = { values: (course?.angle ?? []).map((one) => one * angle.factor), label: "φ", unit: signed(angle.unit) };
  const own = (now?.dimensions ?? []).filter((one) => !one.path.startsWith("segments."));
  return (
    <>
      {wrong && <Missing message={wrong.missing ?? ""} repair={wrong.repair} />}
      {own.length > 0 && <div class="fields">{own.map((one) => <Field label={one.name} value={one.shown} unit={one.unit} path={one.path} key={one.path} />)}</div>}
      {cam.segments.length > 0 && (
        <>
          <h3>{say("segments")}</h3>
          <ol class="segments">{cam.segments.map((segment, k) => <SegmentRow segment={segment} number={k + 1} last={cam.segments.length < 2} key={segment.path} />)}</ol>
        </>
      )}
      {course?.missing && <Missing message={course.missing} repair={course.repair} />}
      {course?.angle && QUANTITIES.map((name) => {
        const values = course[name];
        return values?.length ? <CamChart key={name} title={say(`cam_${name}`)} symbol={(course.unit === "rad" ? "ψ" : "s") + PRIMES[name]} unit={name === "lift" ? signed(lift.unit) : `${signed(lift.unit)}/rad${name === "acceleration" ? "²" : ""}`} values={values} factor={lift.factor} x={x} /> : null;
      })}
    </>
  );
}

function CamChart({ title, symbol, unit, values, factor, x }: { title: string; symbol: string; unit: string; values: (number | null)[]; factor: number; x: { values: number[]; label: string; unit: string } }) {
  const kept = useRef<{ values: (number | null)[]; data: Parameters<typeof ChartView>[0]["data"] } | null>(null);
  if (kept.current?.values !== values) kept.current = { values, data: { title, unit: signed(unit), x, lines: [{ label: symbol, values: values.map((value) => (value === null ? NaN : value * factor)) }] } };
  return (
    <figure class="chart">
      <figcaption class="head">{title}</figcaption>
      <ChartView data={kept.current.data} />
    </figure>
  );
}
