// Plays the motion by time and step by step; the cursor of all curves is its place.
import { computed, effect } from "@preact/signals";
import { camAngles, camSamples } from "./cam";
import { Icon } from "./icons";
import { signed } from "./motion_panel";
import { motion, place, playing, scene, shows, speed } from "./state";
import { fixed, say, withUnit } from "./words";

const SECONDS = 6; // one way at speed 1
const samples = computed(() => (scene.value?.kind === "cam" ? camSamples(scene.value.cam) : motion.value?.last ?? 0));
const whole = computed(() => (scene.value?.kind === "cam" ? !scene.value.cam?.open : motion.value?.closed ?? false));
let forward = 1;

const within = (at: number): number => Math.min(samples.value, Math.max(0, at));
const wrapped = (at: number): number => (whole.value && samples.value ? ((at % samples.value) + samples.value) % samples.value : within(at));

export function step(by: number): void {
  playing.value = false;
  place.value = wrapped(Math.round(place.value) + by);
}
export function toggle(): void {
  if (samples.value > 0) playing.value = !playing.value;
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
    const way = (forward * 2 ** speed.value * samples.value * Math.min(time - before, 250)) / (1000 * SECONDS);
    let at = place.value + (whole.value ? Math.abs(way) : way);
    if (!whole.value) {
      const [low, high] = motion.value?.piece(Math.round(place.value)) ?? [0, samples.value];
      if (at >= high || at <= low) forward = at <= low ? 1 : -1;
      at = Math.min(high, Math.max(low, at));
    }
    place.value = wrapped(at);
    requestAnimationFrame(frame(time));
  };
  requestAnimationFrame((time) => frame(time)(time));
});

const told = computed(() => {
  const now = motion.value;
  if (scene.value?.kind === "cam") {
    const angles = camAngles(scene.value.cam), angle = scene.value.display?.angle ?? { unit: "rad", factor: 1 };
    return angles.length === 0 ? { text: "", bad: false } : { text: `φ = ${withUnit(fixed((angles[Math.round(place.value)] ?? NaN) * angle.factor, 360, 4), signed(angle.unit))}`, bad: false };
  }
  if (!now) return { text: "", bad: false };
  const sample = Math.round(place.value), word = now.word(sample), greatest = Math.max(Math.abs(now.drive[0]!), Math.abs(now.drive[now.last]!)) * now.factor;
  const number = withUnit(fixed(now.driveAt(place.value) * now.factor, greatest, 4), signed(now.unit));
  return { text: `${now.symbol} = ${number}${word ? ` · ${word}` : ""}`, bad: !now.reached(sample) };
});

function Show({ name }: { name: string }) {
  return (
    <label class="choice"><input type="checkbox" checked={shows.value[name]} onChange={(event) => { shows.value = { ...shows.value, [name]: event.currentTarget.checked }; }} /> {say(`show_${name}`)}</label>
  );
}

// Where the mechanism is not reached, and its limits, under the slider.
function Strip() {
  const now = motion.value;
  if (!now || scene.value?.kind === "cam") return null;
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
      <input type="range" data-do="seek" min={0} max={last || 1} step="any" value={place.value} disabled={!last} aria-label={say("position")} aria-valuetext={told.value.text}
        onInput={(event) => { playing.value = false; place.value = within(Number(event.currentTarget.value)); }} />
      <Strip />
      <button type="button" data-do="play" disabled={!last} aria-label={say(playing.value ? "pause" : "play")} title={say(playing.value ? "pause" : "play")} onClick={toggle}><Icon name={playing.value ? "pause" : "play"} /></button>
      <button type="button" data-do="back" disabled={!last} aria-label={say("step_back")} title={say("step_back")} onClick={() => step(-1)}><Icon name="back" /></button>
      <button type="button" data-do="on" disabled={!last} aria-label={say("step_on")} title={say("step_on")} onClick={() => step(1)}><Icon name="on" /></button>
      <output class={told.value.bad ? "bad" : ""}>{told.value.text}</output>
      <label class="speed">{say("speed")} <input type="range" data-do="speed" min={-3} max={2} step={0.5} value={speed.value} onInput={(event) => { speed.value = Number(event.currentTarget.value); }} /></label>
      {!cam && <span class="pair"><Show name="paths" /><Show name="names" /><Show name="velocities" /><Show name="accelerations" /></span>}
    </div>
  );
}
