// Sheets of topics: facts, tables, curves and pictures as the server sends them.
import { effect, signal } from "@preact/signals";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import { CamPanel } from "./cam";
import { CourseView } from "./courses";
import { ChartView, Missing, MotionPanel, signed } from "./motion_panel";
import type { Block, Panel, TopicOption } from "./protocol";
import { arrows, available, hello, LEAST_SCALE, measurePanel, MOST_SCALE, options, panelKey, panels, played, playedPlace, readiness, scene, selection, show, topic, waits } from "./state";
import { fixed, say, sentence, spelled, typeset } from "./words";

// Markup of the server's pictures and formulas, without anything that could act.
export function Markup({ text, className, label }: { text: string; className: string; label?: string }) {
  const holder = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => { // before it is seen: a keyboard scrolls it from the first
    const parsed = new DOMParser().parseFromString(text, "text/html");
    for (const one of parsed.body.querySelectorAll("script, foreignObject, iframe, object, embed, link, metadata")) one.remove();
    for (const one of parsed.body.querySelectorAll("*")) for (const attribute of [...one.attributes]) {
      if (/^on/i.test(attribute.name) || (/href$/i.test(attribute.name) && !attribute.value.startsWith("#"))) one.removeAttribute(attribute.name);
    }
    const picture = parsed.body.querySelector("svg");
    if (picture && label) {
      picture.setAttribute("role", "img");
      picture.setAttribute("aria-label", label);
      // Its letters are as great as those about it, however wide it is on paper.
      const points = parseFloat(picture.getAttribute("width") ?? "");
      if (points) Object.assign(picture.style, { minWidth: `${LEAST_SCALE * points}px`, maxWidth: `${MOST_SCALE * points}px` });
    }
    const element = holder.current!;
    element.replaceChildren(...parsed.body.childNodes);
    // What is wider than its place is scrolled, by keyboard too.
    const scroll = (): void => {
      const wide = element.scrollWidth > element.clientWidth;
      for (const [name, value] of [["tabindex", "0"], ["role", "region"], ["aria-label", label ?? say("formula")]] as const) {
        if (wide) element.setAttribute(name, value);
        else element.removeAttribute(name);
      }
    };
    scroll();
    const watch = new ResizeObserver(scroll);
    watch.observe(element);
    return () => watch.disconnect();
  }, [text, label]);
  return <div class={className} ref={holder} />;
}

// Symbols such as R_n with their indices lowered; names of the description stay as they are written.
const SYMBOL = /(?<![\p{L}\p{N}_])(\p{L}[ⁿᵗʳ′]*_[\p{L}\p{N}]+)(?![\p{L}\p{N}_])/u;
function Symbols({ text }: { text: string }) {
  const now = scene.value, own = (name: string): boolean => [...(now?.points ?? []), ...(now?.links ?? []), ...(now?.guides ?? [])].some((one) => one.name === name);
  return <>{text.split(SYMBOL).map((part, k) => {
    const [sign, index] = part.split("_");
    return k % 2 && !own(part) ? <>{sign}<sub>{index}</sub></> : part;
  })}</>;
}

function Facts({ facts }: { facts: { label: string; text: string }[] }) {
  return (
    <dl class="facts">
      {facts.map((fact) => <div><dt>{fact.label}</dt><dd><Symbols text={typeset(fact.text)} /></dd></div>)}
    </dl>
  );
}

const LONG = 40; // rows: longer tables are scrolled in a place of their own
const LONG_TEXT = 11, LONGEST_TEXT = 60; // letters from which on a column is not narrower than some words

type Table = Extract<Block, { kind: "table" }>;
const longestOf = (block: Table, k: number): number => {
  const column = block.columns[k]!, cells = column.numeric ? [] : block.rows.slice(0, 400).map((row) => String(row[k] ?? "").length);
  return Math.max(column.head.length, ...cells);
};
// A browser that has no room would break texts at every blank.
function headClass(block: Table, k: number): string {
  const column = block.columns[k]!, longest = longestOf(block, k);
  return [column.numeric ? "n" : "", longest > LONGEST_TEXT ? "longest" : longest > LONG_TEXT ? "long" : ""].filter(Boolean).join(" ");
}

function TableView({ block }: { block: Table }) {
  const greatest = block.columns.map((_column, k) => Math.max(0, ...block.rows.slice(0, 2000).map((row) => (typeof row[k] === "number" && Number.isFinite(row[k]) ? Math.abs(row[k] as number) : 0))));
  const holder = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => { // the column that stays is parted from those that pass below it
    const element = holder.current!;
    const watch = new ResizeObserver(() => element.toggleAttribute("data-over", element.scrollWidth > element.clientWidth + 1));
    watch.observe(element);
    return () => watch.disconnect();
  }, []);
  const shown = block.rows.length > 400 ? block.rows.filter((_row, k) => k % Math.ceil(block.rows.length / 400) === 0) : block.rows;
  return (
    <>
      {block.title && <p class="caption">{block.title}</p>}
      <div ref={holder} class={shown.length > LONG ? "table scroll long" : "table scroll"} tabindex={0} role="region" aria-label={block.title || say("table")}>
        <table class={block.columns.length > 0 && longestOf(block, 0) <= LONG_TEXT ? "short" : ""}>
          <thead><tr>{block.columns.map((column, k) => <th scope="col" class={headClass(block, k)}><Symbols text={column.head} />{column.unit && column.unit !== "1" ? <span class="unit">, {signed(column.unit)}</span> : null}</th>)}</tr></thead>
          <tbody>
            {shown.map((row) => <tr>{row.map((cell, k) => <td class={block.columns[k]?.numeric ? "n" : ""}>{typeof cell === "number" ? fixed(cell, greatest[k]!) : <Symbols text={typeset(cell ?? "")} />}</td>)}</tr>)}
          </tbody>
        </table>
      </div>
    </>
  );
}

function BlockView({ block, among }: { block: Block; among: Block[] }) {
  const kept = useRef<{ block: Block; data: Parameters<typeof ChartView>[0]["data"][] } | null>(null);
  switch (block.kind) {
    case "facts":
      return <Facts facts={block.facts} />;
    case "table":
      return <TableView block={block} />;
    case "heading":
      return <h3>{block.text}</h3>;
    case "paragraph":
      return <p class={block.item ? "item" : ""}><Symbols text={typeset(block.item ? block.text : sentence(block.text))} /></p>;
    case "formula":
      return block.mathml ? <Markup className="formula" text={block.mathml} /> : <pre class="formula" tabindex={0} role="region" aria-label={say("formula")}>{typeset(block.text ?? "")}</pre>;
    case "picture":
      return (
        <figure>
          <Markup className="paper" text={block.svg} label={block.alt || block.title || say("picture")} />
          {block.title && <figcaption><Symbols text={block.title} /></figcaption>}
        </figure>
      );
    case "motion":
      return <CourseView block={block} among={among} />;
    case "plot": {
      const now = played.value, follows = Boolean(block.cursor) && now !== null && block.x.values.length === now.samples;
      if (kept.current?.block !== block) {
        // Curves of one unit share a chart.
        const units = [...new Set(block.curves.map((curve) => curve.unit))];
        const numbers = (values: (number | null)[]): Float64Array => Float64Array.from(values, (value) => value ?? NaN);
        kept.current = {
          block,
          data: units.map((unit) => ({
            title: [block.title, block.y?.label].filter(Boolean).join(": "), unit: signed(unit), x: { values: numbers(block.x.values), label: block.x.label, unit: signed(block.x.unit), ends: block.x.ends },
            shaded: (block.shaded ?? []).flatMap(([from, to]) => (from === null || to === null ? [] : [{ from, to }])),
            places: (block.marks ?? []).flatMap((mark) => (mark.at === null ? [] : [{ at: mark.at, label: mark.label }])),
            lines: block.curves.filter((curve) => curve.unit === unit).map((curve) => ({ label: curve.label || block.y?.label || "", values: numbers(curve.values), dashed: curve.dashed, pen: curve.pen, ...(curve.x ? { x: numbers(curve.x) } : {}), ...(curve.finer ? { finer: { x: numbers(curve.finer.x), values: numbers(curve.finer.values) } } : {}) })),
          })),
        };
      }
      return (
        <figure class="chart">
          {(block.title || block.y?.label) && <figcaption class="head"><span><Symbols text={block.title ?? ""} /></span>{block.y?.label && block.y.label !== block.title && <span class="unit"><Symbols text={block.y.label} /></span>}</figcaption>}
          {kept.current.data.map((data) => <ChartView data={data} cursor={follows ? playedPlace.value : null} key={`${follows} ${now?.course !== null}`} />)}
        </figure>
      );
    }
    case "arrows":
      return (
        <label class="choice">
          <input type="checkbox" checked={arrows.value === block} onChange={(event) => { arrows.value = event.currentTarget.checked ? block : null; }} /> {block.title || say("arrows_on_drawing")}
        </label>
      );
  }
}

// Arrows on the drawing belong to the description that they were computed of.
effect(() => {
  const now = topic.value, open = panels.value.get(panelKey(now));
  const found = open?.blocks?.find((block) => block.kind === "arrows") ?? null;
  if (arrows.peek() !== found) arrows.value = found;
});

function Options({ of, name }: { of: TopicOption[]; name: string }) {
  const now = options.value[name] ?? {};
  const put = (option: TopicOption, value: unknown): void => {
    options.value = { ...options.value, [name]: { ...now, [option.name]: value } };
  };
  return (
    <div class="options">
      {of.map((option) => {
        const value = now[option.name] ?? option.value ?? "";
        const label = option.label;
        if (option.kind === "flag") return <label class="choice"><input type="checkbox" checked={Boolean(value)} onChange={(event) => put(option, event.currentTarget.checked)} /> {label}</label>;
        const choices = option.of === "link" ? (scene.value?.links ?? []).map((one) => ({ value: one.name, label: one.name })) : option.kind === "choice" ? option.choices ?? [] : null;
        if (choices) return (
          <label><span>{label}</span>
            <select value={String(value)} onChange={(event) => put(option, event.currentTarget.value || null)}>
              {(option.value === null || option.value === undefined) && <option value="">—</option>}
              {choices.map((choice) => <option value={choice.value}>{choice.label}</option>)}
            </select>
          </label>
        );
        if (option.kind === "number" && option.least !== undefined && option.most !== undefined) return (
          <label class="slide"><span>{option.label}</span>
            <input type="range" min={option.least} max={option.most} step="any" value={Number(value)} onChange={(event) => put(option, Number(event.currentTarget.value))} />
            <output>{spelled(Number(value), 4)}</output>
          </label>
        );
        return <label><span>{label}</span><input type="text" value={String(value)} onChange={(event) => put(option, event.currentTarget.value.trim() || null)} /></label>;
      })}
    </div>
  );
}

const opened = signal(new Set<string>()); // topics whose options are shown

// While a new sheet is computed the last one of its topic stays, so that nothing jumps.
const last = new Map<string, Panel>();

// What the player plays stands on top: its events, or the choice of a motion.
const first = (blocks: Block[]): Block[] => [...blocks].sort((a, b) => Number(b.kind === "motion") - Number(a.kind === "motion"));

function ServerPanel({ name }: { name: string }) {
  const why = available(name), key = panelKey(name), panel = panels.value.get(key), shown = panel ?? last.get(name);
  useEffect(() => void show(), [key]);
  if (why !== true) return <Missing message={why} />;
  if (panel && !panel.missing) last.set(name, panel);
  const own = shown?.options ?? hello.value?.topics.find((one) => one.name === name)?.options ?? [];
  return (
    <div class={panel ? "sheet" : "sheet waits"} aria-busy={!panel}>
      {own.length > 0 && (
        <details class="more" open={opened.value.has(name)} onToggle={(event) => {
          const next = new Set(opened.value);
          if (event.currentTarget.open) next.add(name);
          else next.delete(name);
          if (next.size !== opened.value.size) opened.value = next;
        }}>
          <summary>{say("options")}</summary>
          <Options of={own} name={name} />
        </details>
      )}
      {!shown && <p class="hint">{say("computing")}</p>}
      {shown?.missing && <Missing message={shown.missing} repair={shown.repair} />}
      {first(shown?.blocks ?? []).map((block, k) => <BlockView block={block} among={shown!.blocks} key={`${name} ${k} ${block.kind}`} />)}
    </div>
  );
}

export function ReadinessView() {
  const now = readiness.value;
  if (!now) return null;
  return (
    <div class="readiness">
      {now.missing.map((one) => <p class="lacks">{sentence(one)}</p>)}
      {now.loose.length > 0 && (
        <p class="lacks">{say("loose_points")} {now.loose.map((name) => <button type="button" class="name" onClick={() => { selection.value = [name]; }}>{name}</button>)}</p>
      )}
      {(now.ready ?? (!now.missing.length && !now.loose.length)) && <p class="good">{say("ready")}</p>}
      {now.limit && <p class="limit">{typeset(sentence(now.limit))}</p>}
      <Facts facts={now.facts.slice(0, 1)} />
      {now.facts.length > 1 && <details class="more"><summary>{say("more")}</summary><Facts facts={now.facts.slice(1)} /></details>}
    </div>
  );
}

interface Tab {
  name: string;
  title: string;
}
export const tabs = (): Tab[] => {
  const cam = scene.value?.kind === "cam", kind = cam ? "cam" : "mechanism";
  const own: Tab[] = cam ? [{ name: "cam", title: say("panel_cam") }] : [{ name: "motion", title: say("panel_motion") }];
  const known = (hello.value?.topics ?? []).filter((one) => (!one.for || one.for === kind) && one.name !== "motion" && one.name !== "readiness" && one.name !== "cam");
  const there = (one: Tab): number => Number(available(one.name) !== true); // what does not apply stands behind
  return [...own, ...known.map((one) => ({ name: one.name, title: one.title })).sort((a, b) => there(a) - there(b))];
};

const EDGES = 2; // pixels of the border of a figure
const others = signal(false); // whether tabs of topics are shown that the description does not have

export function PanelCard() {
  const all = tabs(), now = all.some((one) => one.name === topic.value) ? topic.value : all[0]!.name;
  const shown = all.filter((one) => others.value || one.name === now || available(one.name) === true), away = all.filter((one) => available(one.name) !== true).length;
  useEffect(() => {
    if (scene.value && topic.value !== now) topic.value = now;
  }, [now, scene.value]);
  const body = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    const element = body.current!;
    let soon = 0;
    measurePanel(element.clientWidth - EDGES);
    const watch = new ResizeObserver(() => { // not at every step of a hand that moves an edge of the window
      clearTimeout(soon);
      soon = window.setTimeout(() => measurePanel(element.clientWidth - EDGES), 200);
    });
    watch.observe(element);
    return () => {
      clearTimeout(soon);
      watch.disconnect();
    };
  }, []);
  const go = (event: KeyboardEvent): void => {
    const by = event.key === "ArrowRight" || event.key === "ArrowDown" ? 1 : event.key === "ArrowLeft" || event.key === "ArrowUp" ? -1 : 0;
    const at = shown.findIndex((one) => one.name === now), next = event.key === "Home" ? 0 : event.key === "End" ? shown.length - 1 : (at + by + shown.length) % shown.length;
    if (!by && event.key !== "Home" && event.key !== "End") return;
    event.preventDefault();
    topic.value = shown[next]!.name;
    (event.currentTarget as HTMLElement).querySelectorAll<HTMLElement>('[role="tab"]')[next]?.focus();
  };
  return (
    <section class="card panel" aria-label={say("panels")}>
      <select class="tab-list" aria-label={say("panels")} value={now} onChange={(event) => { topic.value = event.currentTarget.value; }}>
        {all.map((one) => <option value={one.name} disabled={available(one.name) !== true}>{one.title}</option>)}
      </select>
      <div class="tabs" role="tablist" aria-label={say("panels")} onKeyDown={go}>
        {shown.map((one) => (
          <button type="button" role="tab" id={`tab-${one.name}`} aria-controls="panel" aria-selected={one.name === now} tabindex={one.name === now ? 0 : -1}
            class={available(one.name) === true ? "" : "away"} onClick={() => { topic.value = one.name; }}>{one.title}</button>
        ))}
      </div>
      {away > 0 && <button type="button" class="others" aria-expanded={others.value} onClick={() => { others.value = !others.value; }}>{say("other_topics", { count: away })}</button>}
      <div role="tabpanel" id="panel" ref={body} aria-labelledby={`tab-${now}`} tabindex={0} class="panel-body" data-topic={now} data-ready={now === "motion" || now === "cam" || available(now) !== true || panels.value.has(panelKey(now))}>
        {waits.value !== null && <div class="waiting" role="presentation" />}
        {now === "motion" ? <MotionPanel /> : now === "cam" ? <CamPanel /> : <ServerPanel name={now} key={now} />}
      </div>
    </section>
  );
}
