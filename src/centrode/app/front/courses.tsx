// Motions that topics have found: their events on the slider and in a list, and the choice among several.
import { computed } from "@preact/signals";
import type { EventMark, Motion } from "./motion";
import type { Block, MotionBlock } from "./protocol";
import { chosenCourse, course, coursePlace, playing, resting, seek, topic } from "./state";
import { say, typeset } from "./words";

const PLACES = 400; // of a slider: marks that lie nearer to each other are one
const SAME = 1e-3; // samples: a place that was gone to is that of its event

// The events at a place.
export const marksAt = (now: Motion, at: number): EventMark[] => (now.course?.marks ?? []).filter((mark) => Math.abs(mark.at - at) < SAME).slice(0, 3);

// Page keys on the slider go from event to event; says whether the key was one of them.
export function leap(key: string): boolean {
  const marks = course.value?.course?.marks ?? [], here = coursePlace.value;
  if (!marks.length || (key !== "PageUp" && key !== "PageDown")) return false;
  const found = key === "PageUp" ? marks.find((mark) => mark.at > here + SAME) : marks.filter((mark) => mark.at < here - SAME).at(-1);
  if (found) seek(found.at);
  return true;
}

export const Sign = ({ of }: { of: EventMark["sign"] }) => <i class={`sign ${of}`} aria-hidden="true" />;

// Under the slider: what holds is shaded, every event has its sign; the list in the panel says the same in words.
export function EventStrip({ of }: { of: Motion }) {
  const { marks, held } = of.course!;
  if (!marks.length && !held.length) return null;
  const share = (at: number): number => of.slideOf(at) / Math.max(1, of.last);
  const signs = new Map<string, { mark: EventMark; labels: Set<string> }>();
  for (const mark of marks) {
    const key = `${Math.round(share(mark.at) * PLACES)} ${mark.sign}`, known = signs.get(key);
    if (known) known.labels.add(mark.label);
    else signs.set(key, { mark, labels: new Set([mark.label]) });
  }
  const near = (event: MouseEvent): void => {
    const box = (event.currentTarget as HTMLElement).getBoundingClientRect(), x = (event.clientX - box.left) / box.width;
    if (marks.length) seek(marks.reduce((best, mark) => (Math.abs(share(mark.at) - x) < Math.abs(share(best.at) - x) ? mark : best)).at);
  };
  return (
    <div class="strip events" aria-hidden="true" onClick={near}>
      {held.map((one) => <span class="held" title={one.label} style={{ left: `${100 * share(one.from)}%`, width: `${Math.max(0.2, 100 * (share(one.to) - share(one.from)))}%` }} />)}
      {[...signs.values()].map(({ mark, labels }) => <span class="tick" title={[...labels].slice(0, 6).join(", ")} style={{ left: `${100 * share(mark.at)}%` }}><Sign of={mark.sign} /></span>)}
    </div>
  );
}

// The last event up to the place of the player.
const passed = computed(() => {
  const marks = course.value?.course?.marks ?? [], at = coursePlace.value + SAME;
  return marks.reduce((last, mark, k) => (mark.at <= at ? k : last), -1);
});

function EventList({ events }: { events: NonNullable<MotionBlock["events"]> }) {
  const marks = course.value?.course?.marks ?? [], now = passed.value, least = Math.max(0, now);
  const go = (event: KeyboardEvent): void => {
    const rows = [...(event.currentTarget as HTMLElement).querySelectorAll<HTMLElement>("button")], here = rows.indexOf(event.target as HTMLElement);
    const to = { ArrowDown: here + 1, ArrowUp: here - 1, Home: 0, End: rows.length - 1 }[event.key];
    if (here < 0 || to === undefined) return;
    event.preventDefault();
    rows[Math.min(rows.length - 1, Math.max(0, to))]!.focus();
  };
  return (
    <>
      <p class="caption">{events.title}{events.count > events.rows.length ? `: ${say("events_first", { shown: events.rows.length, count: events.count })}` : ""}</p>
      <div class={events.rows.length > 12 ? "table scroll event-list long" : "table scroll event-list"} tabindex={0} role="region" aria-label={events.title}>
        <table>
          <thead><tr>{events.columns.map((head, k) => <th scope="col" class={k === 0 || k > 2 ? "n" : ""}>{head}</th>)}</tr></thead>
          <tbody onKeyDown={go}>
            {events.rows.map((row, k) => (
              <tr aria-current={k === now ? "true" : undefined}>
                {row.map((cell, column) => (column === 0
                  ? <td class="n"><button type="button" tabindex={k === least ? 0 : -1} title={say("event_go")} onClick={() => marks[k] && seek(marks[k].at)}>{marks[k] && <Sign of={marks[k].sign} />}{typeset(cell)}</button></td>
                  : <td class={column > 2 ? "n" : ""}>{typeset(cell)}</td>))}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </>
  );
}

function choose(number: number): void {
  const same = course.value !== null && (chosenCourse.value[topic.value] ?? 0) === number;
  chosenCourse.value = { ...chosenCourse.value, [topic.value]: number };
  resting.value = false;
  if (!same) coursePlace.value = 0;
  playing.value = same ? !playing.value : true;
}

// Of several motions of a panel one is played; the first block offers them all.
export function CourseView({ block, among }: { block: MotionBlock; among: Block[] }) {
  const all = among.filter((one) => one.kind === "motion");
  const chosen = Math.min(chosenCourse.value[topic.value] ?? 0, Math.max(0, all.length - 1));
  if (!block.loops) return block.events ? <EventList events={block.events} /> : null;
  if (block.number > 0) return null;
  return (
    <div class="courses" role="group" aria-label={say("played_motion")}>
      {all.map((one) => (
        <button type="button" aria-pressed={one.number === chosen} data-course={one.number} onClick={() => choose(one.number)}>{typeset(one.title ?? "")}</button>
      ))}
    </div>
  );
}
