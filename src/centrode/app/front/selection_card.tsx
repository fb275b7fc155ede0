// What is selected: its state rows, its numbers, and what can be done with it.
import { signal } from "@preact/signals";
import { Icon } from "./icons";
import { signed } from "./motion_panel";
import { type Dimension, ROWS, type Row, type RowName } from "./protocol";
import { edit, readiness, scene, selection } from "./state";
import { say, sentence } from "./words";

const why = signal<string>(""); // of the row under pointer or focus

// What is refused stays in its field to be mended while somebody is there; a field that is left shows what holds.
async function attempt(field: HTMLInputElement, holds: string, change: () => Promise<unknown>): Promise<unknown> {
  const answer = await change();
  if (answer) field.removeAttribute("aria-invalid");
  else if (document.activeElement === field) field.setAttribute("aria-invalid", "true");
  else field.value = holds;
  return answer;
}
const leave = (field: HTMLInputElement, holds: string): void => {
  if (!field.hasAttribute("aria-invalid")) return;
  field.removeAttribute("aria-invalid");
  field.value = holds;
};

export async function removeSelected(): Promise<void> {
  if (selection.value.length) await edit({ do: "delete", objects: selection.value });
}
export async function duplicateSelected(): Promise<void> {
  const now = scene.value;
  if (!selection.value.length || !now) return;
  const at = now.points.flatMap((point) => (point.at ? [point.at] : [])), wide = Math.max(...at.map((one) => one[0]!)) - Math.min(...at.map((one) => one[0]!));
  const chosen = new Set(selection.value), aside = [0.15 * (wide || 1), -0.15 * (wide || 1)];
  // on the sphere the server turns the copy aside
  const answer = await edit({ do: "duplicate", objects: selection.value, ...(now.kind === "sphere" ? {} : { by: aside }) });
  // the copy is at hand: of it the kinds of objects that were selected
  const kinds = (["points", "links", "guides"] as const).filter((kind) => now[kind].some((one) => chosen.has(one.name)));
  const copies = kinds.flatMap((kind) => answer?.scene?.[kind].map((one) => one.name).filter((name) => answer.named?.includes(name)) ?? []);
  if (copies.length) selection.value = copies;
}
// About the upright or the level line through the middle of what is selected.
export async function mirrorSelected(upright: boolean): Promise<void> {
  const now = scene.value;
  if (!selection.value.length || !now) return;
  if (now.kind === "sphere") {
    await edit({ do: "mirror", objects: selection.value, axis: upright ? "y" : "x" });
    return;
  }
  const names = new Set([...selection.value, ...now.links.filter((one) => selection.value.includes(one.name)).flatMap((one) => one.points)]);
  const at = now.points.filter((point) => names.has(point.name) && point.at).map((point) => point.at!);
  if (!at.length) return;
  const middle = [0, 1].map((axis) => (Math.min(...at.map((one) => one[axis]!)) + Math.max(...at.map((one) => one[axis]!))) / 2);
  await edit({ do: "mirror", objects: selection.value, axis: [middle, [middle[0]! + (upright ? 0 : 1), middle[1]! + (upright ? 1 : 0)]] });
}

function StateRow({ name, row, of }: { name: RowName; row: Row | undefined; of: string[] }) {
  const allowed = row?.allowed ?? false, on = row?.on ?? false, reason = allowed ? "" : sentence(row?.why) || say("row_no_object");
  const valued = on && row && row.value !== undefined && row.value !== null && allowed && of.length === 1;
  const put = (value?: unknown) => edit(...of.map((object) => ({ do: "set_row", object, row: name, on: value !== undefined ? true : !on, ...(value !== undefined ? { value } : {}) })));
  const angle = scene.value?.display?.angle ?? { unit: "rad", factor: 1 }, shown = name === "guide" ? angle : { unit: row?.unit ?? "", factor: 1 };
  const numbers = valued ? (Array.isArray(row.value) ? row.value : [row.value]) : [];
  return (
    <div class={on ? "state on" : "state"}>
      <button type="button" class="row-name" aria-pressed={on} aria-disabled={!allowed} data-row={name} title={reason || undefined}
        aria-describedby={reason ? "row-why" : undefined}
        onPointerEnter={() => { why.value = reason; }} onPointerLeave={() => { why.value = ""; }} onFocus={() => { why.value = reason; }} onBlur={() => { why.value = ""; }}
        onClick={() => { if (allowed) void put(); else why.value = reason; }}>
        <Icon name={name} /> {say(`row_${name}`)}
      </button>
      {numbers.map((one) => String(typeof one === "number" ? Number((one * shown.factor).toPrecision(6)) : one ?? "")).map((holds, k) => (
        <input type="text" inputMode="decimal" aria-label={`${say(`row_${name}`)}${numbers.length > 1 ? ` ${"xyz"[k]}` : ""}`} value={holds}
          onBlur={(event) => leave(event.currentTarget, holds)}
          onChange={(event) => {
            const read = Number(event.currentTarget.value.replace("−", "-").replace(",", ".")), value = Number.isFinite(read) && event.currentTarget.value.trim() ? read / shown.factor : event.currentTarget.value;
            void attempt(event.currentTarget, holds, () => put(numbers.length > 1 ? numbers.map((other, j) => (j === k ? value : other)) : value));
          }} />
      ))}
      {numbers.length > 0 && shown.unit && <span class="unit">{signed(shown.unit)}</span>}
    </div>
  );
}

function DimensionRow({ one, among }: { one: Dimension; among: boolean }) {
  const lockable = one.lockable ?? /\.length$/.test(one.path);
  return (
    <div class="dimension">
      <label for={`dimension-${one.path}`}>{among ? `${one.name}(${one.of})` : one.name}</label>
      <input id={`dimension-${one.path}`} type="text" inputMode="decimal" value={one.shown} data-path={one.path} autocomplete="off" onBlur={(event) => leave(event.currentTarget, one.shown)}
        onChange={(event) => { const { value } = event.currentTarget; void attempt(event.currentTarget, one.shown, () => edit({ do: "set", path: one.path, value })); }} />
      <span class="unit">{signed(one.unit)}</span>
      {lockable ? (
        <button type="button" class="plain" aria-pressed={one.locked ?? false} title={say(one.locked ? "unlock" : "lock")} aria-label={`${say(one.locked ? "unlock" : "lock")}: ${one.of ?? ""} ${one.name}`}
          onClick={() => void edit({ do: "lock", path: one.path, on: !one.locked })}><Icon name={one.locked ? "lock" : "unlock"} /></button>
      ) : <span />}
    </div>
  );
}

export function SelectionCard() {
  const now = scene.value, names = selection.value;
  if (!now || now.kind === "cam") return null;
  const first = names[0], rows = first ? now.rows[first] : undefined;
  // A row is there for several objects where it is for each of them.
  const joint = (name: RowName): Row | undefined => {
    const all = names.map((object) => now.rows[object]?.[name]).filter((row): row is Row => Boolean(row));
    if (!all.length) return undefined;
    const allowed = all.filter((row) => row.allowed);
    return { ...(allowed[0] ?? all[0]!), on: (allowed.length ? allowed : all).every((row) => row.on), allowed: allowed.length > 0 };
  };
  const able = (name: RowName): string[] => names.filter((object) => now.rows[object]?.[name]?.allowed);
  const hinged = hingeOf(names);
  const dimensions = (now.dimensions ?? []).filter((one) => (first ? names.includes(one.of ?? "") : false));
  return (
    <section class="card selection" aria-label={say("selection")}>
      <h2>{first ? (names.length > 1 ? say("selected_many", { count: names.length }) : null) : say("selection")}
        {first && names.length === 1 && (
          <label class="rename"><span class="kind">{say(kindOf(first))}</span>
            <input type="text" aria-label={say("name")} value={first} spellcheck={false} onBlur={(event) => leave(event.currentTarget, first)} onChange={(event) => {
              const name = event.currentTarget.value.trim();
              if (name && name !== first) void attempt(event.currentTarget, first, () => edit({ do: "rename", object: first, name })).then((answer) => { if (answer) selection.value = [name]; });
              else event.currentTarget.value = first;
            }} />
          </label>
        )}
      </h2>
      {!first && <p class="hint">{say(now.points.length ? "nothing_selected" : "empty_stage")}</p>}
      {first && rows && (
        <>
          <div class="states">{ROWS.map((name) => <StateRow name={name} row={joint(name)} of={able(name)} key={`${first} ${name}`} />)}</div>
          <p class="why" id="row-why" aria-live="polite">{why.value}</p>
          {dimensions.length > 0 && <div class="dimensions">{dimensions.map((one) => <DimensionRow one={one} among={names.length > 1} key={one.path} />)}</div>}
        </>
      )}
      {first && (
        <div class="buttons">
          {names.length === 2 && names.every((name) => now.points.some((point) => point.name === name)) && (
            <button type="button" data-do="join" onClick={() => void edit({ do: "join", points: names })}>{say("join")}</button>
          )}
          {hinged && <button type="button" data-do="hinge" onClick={() => void edit({ do: "add_point", link: hinged.link, point: hinged.point })}>{say("hinge", hinged)}</button>}
          <button type="button" data-do="duplicate" onClick={() => void duplicateSelected()}>{say("duplicate")}</button>
          <button type="button" data-do="mirror-upright" onClick={() => void mirrorSelected(true)}>{say("mirror_upright")}</button>
          <button type="button" data-do="mirror-level" onClick={() => void mirrorSelected(false)}>{say("mirror_level")}</button>
          <button type="button" onClick={() => void removeSelected()}>{say("delete")}</button>
        </div>
      )}
    </section>
  );
}

// A joint and a link that does not have it: they can be hinged.
function hingeOf(names: string[]): { point: string; link: string } | null {
  const now = scene.value!, point = now.points.find((one) => names.includes(one.name)), link = now.links.find((one) => names.includes(one.name));
  return names.length === 2 && point && link && !link.points.includes(point.name) ? { point: point.name, link: link.name } : null;
}

const kindOf = (name: string): string => {
  const now = scene.value!;
  if (now.points.some((one) => one.name === name)) return "kind_point";
  return now.links.some((one) => one.name === name) ? "kind_link" : "kind_guide";
};
export const loose = (): string[] => readiness.value?.loose ?? [];
