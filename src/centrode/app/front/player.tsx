// Plays the motion by time and step by step; the cursor of all curves is its place.
import { computed, effect } from "@preact/signals";
import { camAngles, camSamples } from "./cam";
import { Icon } from "./icons";
import { signed } from "./motion_panel";
import { EventStrip, leap, marksAt } from "./courses";
import { played, playedPlace, playing, resting, scene, seek, shows, speed } from "./state";
import { fixed, say, withUnit } from "./words";

const SECONDS = 6; // one way of a cam at speed 1
const samples = computed(() => (scene.value?.kind === "cam" ? camSamples(scene.value.cam) : played.value?.last ?? 0));
const whole = computed(() => (scene.value?.kind === "cam" ? !scene.value.cam?.open : played.value?.whole ?? false));
const slide = computed(() => played.value?.slideOf(playedPlace.value.value) ?? playedPlace.value.value);
const placeOf = (at: number): number => played.value?.placeOf(at) ?? at;
let forward = 1;

const within = (at: number): number => Math.min(samples.value, Math.max(0, at));
const wrapped = (at: number): number => (whole.value && samples.value ? ((at % samples.value) + samples.value) % samples.value : within(at));

export function step(by: number): void {
  seek(wrapped(Math.round(playedPlace.value.value) + by));
}
export function toggle(): void {
  if (!samples.value) return;
  const now = played.value, at = playedPlace.value;
  resting.value = false;
  if (!playing.value && now?.course && !now.whole && at.value >= now.last) at.value = 0; // once more from the beginning
  playing.value = !playing.value;
}

let running = false;
effect(() => {
  if (!playing.value || running) return;
  running = true;
  const frame = (before: number) => (time: number): void => {
    if (!playing.value || !samples.value) {
      running = false;
      playing.value = false;
      return;
    }
    const now = played.value, at = playedPlace.value, seconds = now?.seconds ?? SECONDS, once = Boolean(now?.course) && !whole.value;
    if (once) forward = 1;
    const way = (forward * 2 ** speed.value * samples.value * Math.min(time - before, 250)) / (1000 * seconds);
    let next = slide.value + (whole.value ? Math.abs(way) : way);
    if (!whole.value) {
      const [low, high] = now?.piece(Math.round(at.value)) ?? [0, samples.value];
      if (next >= high || next <= low) forward = next <= low ? 1 : -1;
      if (once && next >= samples.value) playing.value = false;
      next = Math.min(high, Math.max(low, next));
    }
    at.value = placeOf(wrapped(next));
    requestAnimationFrame(frame(time));
  };
  requestAnimationFrame((time) => frame(time)(time));
});

const told = computed(() => {
  const now = played.value, place = playedPlace.value;
  if (scene.value?.kind === "cam") {
    const angles = camAngles(scene.value.cam), angle = scene.value.display?.angle ?? { unit: "rad", factor: 1 };
    return angles.length === 0 ? { text: "", bad: false } : { text: `φ = ${withUnit(fixed((angles[Math.round(place.value)] ?? NaN) * angle.factor, 360, 4), signed(angle.unit))}`, bad: false };
  }
  if (!now) return { text: "", bad: false };
  const sample = Math.round(place.value), word = now.word(sample), greatest = Math.max(Math.abs(now.drive[0]!), Math.abs(now.drive[now.last]!)) * now.factor;
  const number = withUnit(fixed(now.driveAt(place.value) * now.factor, greatest, 4), signed(now.unit));
  if (now.course?.loops) return { text: now.course.title, bad: false };
  const events = marksAt(now, place.value).map((one) => one.label).join(", ");
  return { text: `${now.symbol} = ${number}${word ? ` · ${word}` : ""}${events ? ` · ${events}` : ""}`, bad: !now.reached(sample) };
});

function Show({ name }: { name: string }) {
  return (
    <label class="choice"><input type="checkbox" checked={shows.value[name]} onChange={(event) => { shows.value = { ...shows.value, [name]: event.currentTarget.checked }; }} /> {say(`show_${name}`)}</label>
  );
}

// Where the mechanism is not reached, and its limits, under the slider.
function Strip() {
  const now = played.value;
  if (!now || scene.value?.kind === "cam") return null;
  if (now.course) return <EventStrip of={now} />;
  const pieces: { from: number; to: number }[] = [];
  for (let k = 0; k < now.samples; k += 1) {
    if (now.reached(k)) continue;
    const last = pieces[pieces.length - 1];
    if (last && last.to === k - 1) last.to = k;
    else pieces.push({ from: k, to: k });
  }
  const marks = now.events.map((event) => ({ at: now.sampleOf(event.drive), kind: event.kind })).filter((one) => one.at !== null);
  if (!pieces.length && !marks.length) return null;
  const share = (sample: number): number => (1000 * sample) / Math.max(1, now.last);
  return (
    <div class="strip" aria-hidden="true">
      <svg viewBox="0 0 1000 6" preserveAspectRatio="none">
        {pieces.map((one) => <rect class="band" x={share(one.from)} y={0} width={Math.max(4, share(one.to - one.from))} height={6} />)}
        {marks.map((one) => <rect class={`mark ${one.kind === "limit" ? "limit" : "change"}`} x={share(one.at!) - 2} y={0} width={4} height={6} />)}
      </svg>
    </div>
  );
}

export function Player() {
  const last = samples.value, cam = scene.value?.kind === "cam";
  return (
    <div class="controls">
      <input type="range" data-do="seek" min={0} max={last || 1} step="any" value={slide.value} disabled={!last} aria-label={say("position")} aria-valuetext={told.value.text}
        onKeyDown={(event) => { if (leap(event.key)) event.preventDefault(); }} onInput={(event) => seek(placeOf(within(Number(event.currentTarget.value))))} />
      <Strip />
      <button type="button" data-do="play" disabled={!last} aria-label={say(playing.value ? "pause" : "play")} title={say(playing.value ? "pause" : "play")} onClick={toggle}><Icon name={playing.value ? "pause" : "play"} /></button>
      <button type="button" data-do="back" disabled={!last} aria-label={say("step_back")} title={say("step_back")} onClick={() => step(-1)}><Icon name="back" /></button>
      <button type="button" data-do="on" disabled={!last} aria-label={say("step_on")} title={say("step_on")} onClick={() => step(1)}><Icon name="on" /></button>
      <output class={`${told.value.bad ? "bad" : ""} ${played.value?.course ? "steady" : ""}`} title={played.value?.course ? told.value.text : undefined}>{told.value.text}</output>
      <label class="speed">{say("speed")} <input type="range" data-do="speed" min={-3} max={2} step={0.5} value={speed.value} onInput={(event) => { speed.value = Number(event.currentTarget.value); }} /></label>
      {!cam && <span class="pair"><Show name="paths" /><Show name="names" /><Show name="velocities" /><Show name="accelerations" /></span>}
    </div>
  );
}
