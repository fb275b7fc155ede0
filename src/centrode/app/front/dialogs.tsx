// Windows over the page: opening, saving, exporting, sharing, the photo, the keys.
import { signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { byHand, copyText } from "./motion_panel";
import { photo, put, readPhoto, scalePhoto, scaleTo } from "./photo";
import type { Place, Template } from "./protocol";
import { unpack } from "./share";
import { BLANK, LINK, ask, available, fileName, fileNow, fits, hello, link, load, mode, options, refused, savedAs, scene, takeTyped, tell, text, unsaved } from "./state";
import { token } from "./token";
import { language, say, sentences, spelled, unitText } from "./words";

export const dialog = signal<"" | "open" | "save" | "export" | "photo" | "keys" | "discard">("");
let onward: (() => void) | null = null; // what follows when changes may be lost

function Window({ name, title, children, onClose }: { name: string; title: string; children: ComponentChildren; onClose?: () => void }) {
  const holder = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    const element = holder.current!;
    if (!element.open) element.showModal();
    return () => element.close();
  }, []);
  return (
    <dialog ref={holder} class={`window ${name}`} aria-label={title} onClose={() => { dialog.value = dialog.value === name ? "" : dialog.value; onClose?.(); }}
      onClick={(event) => { if (event.target === holder.current) holder.current!.close(); }}>
      <div class="inside">
        <div class="window-head"><h2>{title}</h2><button type="button" class="plain" aria-label={say("close")} title={say("close")} onClick={() => holder.current!.close()}>×</button></div>
        {children}
      </div>
    </dialog>
  );
}

// Changes of a file that are not saved are not thrown away by the way; undo brings any text back besides.
const careful = (act: () => void): void => {
  takeTyped();
  if (!unsaved.value) {
    act();
    return;
  }
  onward = act;
  dialog.value = "discard";
};

const take = (next: string, name: string | null, onDisk: boolean): void => careful(() => {
  load(next, name, onDisk);
  dialog.value = "";
});
export const fresh = (): void => careful(() => {
  load(hello.value?.blank ?? BLANK, null, false);
  mode.value = "draw";
  dialog.value = "";
});

// --- opening -----------------------------------------------------------------------------------------------------------
const filter = signal("");
const files = signal<string[]>([]);
const address = signal("");
const wrong = signal("");

async function example(template: Template): Promise<void> {
  const answer = await ask({ do: "example", name: template.name });
  if (answer.error) refused(answer.error);
  else take(answer.text, null, false);
}
async function openFile(name: string): Promise<void> {
  const answer = await ask({ do: "open", name });
  if (answer.error) wrong.value = sentences(answer.error.message, answer.error.repair);
  else take(answer.text, name, true);
}
async function importLink(): Promise<void> {
  const own = LINK.exec(address.value);
  if (own) {
    try {
      take(await unpack(own[1]!), null, false);
    } catch {
      wrong.value = say("link_damaged");
    }
    return;
  }
  const answer = await ask({ do: "import", url: address.value.trim() });
  if (answer.error || answer.missing) wrong.value = sentences(answer.error?.message ?? answer.missing, answer.error?.repair ?? answer.repair);
  else take(answer.text, null, false);
}

const DRAWING = /\.(svg|dxf|linkage2)$/i;
const base64 = (file: File): Promise<string> => new Promise((done, failed) => {
  const reader = new FileReader();
  reader.onload = () => done(String(reader.result).replace(/^[^,]*,?/, ""));
  reader.onerror = failed;
  reader.readAsDataURL(file);
});
async function fromComputer(file: File): Promise<void> {
  if (file.size >= 1_200_000) wrong.value = say("too_large");
  else if (DRAWING.test(file.name)) {
    const answer = await ask({ do: "import", name: file.name, content: await base64(file) });
    if (answer.error || answer.missing) wrong.value = sentences(answer.error?.message ?? answer.missing, answer.error?.repair ?? answer.repair);
    else {
      take(answer.text, null, false);
      tell((answer.told as string[]).join(" · "));
    }
  } else take(await file.text(), null, false);
}

// A file that is dropped on the page: a picture goes behind the drawing, all others are opened.
export async function openDropped(file: File): Promise<void> {
  if (file.type.startsWith("image/") && !DRAWING.test(file.name)) {
    readInView(file);
    return;
  }
  wrong.value = "";
  await fromComputer(file);
  if (wrong.value && !dialog.value) tell(wrong.value, true);
}

function OpenWindow() {
  const sought = filter.value.toLowerCase(), shown = (hello.value?.templates ?? []).filter((one) => `${one.title} ${one.name}`.toLowerCase().includes(sought));
  const groups = [...new Set(shown.map((one) => (one as Template & { group?: string }).group ?? ""))];
  useEffect(() => {
    wrong.value = "";
    if (hello.value?.folder) void ask({ do: "files" }).then((answer) => { if (answer.files) files.value = answer.files; });
  }, []);
  return (
    <Window name="open" title={say("open")}>
      {wrong.value && <p class="bad" role="alert">{wrong.value}</p>}
      <section>
        <h3>{say("from_files")}</h3>
        <div class="buttons">
          {files.value.map((name) => <button type="button" onClick={() => void openFile(name)}>{name}</button>)}
          <label class="button file">{say("from_computer")}
            <input type="file" accept=".toml,.svg,.dxf,.linkage2,text/plain" onChange={(event) => {
              const file = event.currentTarget.files?.[0];
              if (file) void fromComputer(file);
            }} />
          </label>
        </div>
        <form class="line" onSubmit={(event) => { event.preventDefault(); void importLink(); }}>
          <label for="pmks">{say("link_field")}</label>
          <input id="pmks" type="text" value={address.value} onInput={(event) => { address.value = event.currentTarget.value; }} />
          <button type="submit">{say("import")}</button>
        </form>
      </section>
      <section>
        <h3>{say("templates")}</h3>
        <input type="search" class="filter" aria-label={say("filter")} placeholder={say("filter")} value={filter.value} onInput={(event) => { filter.value = event.currentTarget.value; }} />
        <div class="templates">
          {groups.map((group) => (
            <div>
              {group && <h4>{group}</h4>}
              <ul>{shown.filter((one) => ((one as Template & { group?: string }).group ?? "") === group).map((one) => <li><button type="button" class="template" data-template={one.name} onClick={() => void example(one)}>{one.title || one.name}</button></li>)}</ul>
            </div>
          ))}
          {`${say("gear_pair")} gears`.toLowerCase().includes(sought) && (
            <div>
              <h4>{say("gears")}</h4>
              <ul><li><a class="template" data-do="gears" href={`/gears?${new URLSearchParams({ language: language.value, token })}`} target="_blank">{say("gear_pair")}</a></li></ul>
            </div>
          )}
          {`${say("synthesis_lead")} ${say("synthesis")}`.toLowerCase().includes(sought) && (
            <div>
              <h4>{say("synthesis")}</h4>
              <ul><li><a class="template" data-do="synthesis" href={`/synthesis?${new URLSearchParams({ language: language.value, token })}`}>{say("synthesis_lead")}</a></li></ul>
            </div>
          )}
        </div>
      </section>
    </Window>
  );
}

// --- saving ------------------------------------------------------------------------------------------------------------
const wished = signal("");

const sha = async (value: string): Promise<string> => {
  const bytes = new Uint8Array(await crypto.subtle.digest("SHA-256", new TextEncoder().encode(value)));
  return [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
};

async function write(name: string): Promise<boolean> {
  takeTyped();
  const file = fileNow(), sent = text.value;
  const expected = name === file.name && file.saved !== null ? await sha(file.saved) : undefined;
  const answer = await ask({ do: "save", name, text: sent, ...(expected ? { expected } : {}) });
  if (answer.error) {
    wrong.value = sentences(answer.error.message, answer.error.repair);
    return false;
  }
  savedAs(file, answer.name ?? name, sent);
  tell(say("saved", { name: file.name! }));
  return true;
}
export async function saveNow(): Promise<void> {
  wrong.value = "";
  if (fileName.value && (await write(fileName.value))) return;
  wished.value = fileName.value ?? `${(scene.value?.title ?? "").toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "") || "mechanism"}.toml`;
  dialog.value = "save";
}
export function download(content: BlobPart, name: string, type = "text/plain"): void {
  const url = URL.createObjectURL(new Blob([content], { type })), anchor = document.createElement("a");
  Object.assign(anchor, { href: url, download: name });
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
function SaveWindow() {
  return (
    <Window name="save" title={say("save")}>
      {wrong.value && <p class="bad" role="alert">{wrong.value}</p>}
      <form class="line" onSubmit={(event) => { event.preventDefault(); void write(wished.value.trim()).then((done) => { if (done) dialog.value = ""; }); }}>
        <label for="wished">{say("file_name")}</label>
        <input id="wished" type="text" value={wished.value} onInput={(event) => { wished.value = event.currentTarget.value; }} />
        <button type="submit">{say("save")}</button>
      </form>
      <div class="buttons"><button type="button" onClick={() => download(text.value, wished.value || "mechanism.toml")}>{say("download")}</button></div>
    </Window>
  );
}

// Formats that are called by a name.
const NAMED: Record<string, string> = { python: "Python", javascript: "JavaScript", FCMacro: "FCMacro" };
const formatName = (format: string): string => NAMED[format] ?? format.toUpperCase();

// --- exports -----------------------------------------------------------------------------------------------------------
const running = signal("");

async function exportFile(topicName: string, format: string): Promise<void> {
  running.value = `${topicName} ${format}`;
  try {
    const answer = await fetch("/export", {
      method: "POST", headers: { "Content-Type": "application/json" },
      body: JSON.stringify({ token, text: text.value, topic: topicName, format, options: options.value[topicName] ?? {}, language: language.value }),
    });
    if (!answer.ok) {
      const answered = await answer.json().catch(() => ({ message: say("server_gone") }));
      wrong.value = sentences(answered.error?.message ?? answered.message, answered.error?.repair ?? answered.repair);
      return;
    }
    const name = /filename\*?=(?:UTF-8'')?"?([^";]+)/i.exec(answer.headers.get("Content-Disposition") ?? "")?.[1] ?? `${topicName}.${format}`;
    download(await answer.blob(), decodeURIComponent(name), answer.headers.get("Content-Type") ?? "");
    wrong.value = "";
  } catch {
    wrong.value = say("server_gone");
  } finally {
    running.value = "";
  }
}

function ExportWindow() {
  const kind = scene.value?.kind === "cam" ? "cam" : "mechanism";
  const all = [...(hello.value?.exports ?? []), ...(hello.value?.topics ?? []).map((one) => ({ name: one.name, title: one.title, formats: one.formats ?? [], for: one.for }))]
    .filter((one) => one.formats.length && (!one.for || one.for === kind) && available(one.name) === true);
  return (
    <Window name="export" title={say("export")} onClose={() => { wrong.value = ""; }}>
      {wrong.value && <p class="bad" role="alert">{wrong.value}</p>}
      <div class="export-list">
        {all.map((one) => (
          <div class="export-row"><span>{one.title}</span>
            <span class="formats">{one.formats.map((format) => (
              <button type="button" disabled={running.value !== ""} aria-busy={running.value === `${one.name} ${format}`} aria-label={`${one.title}: ${formatName(format)}`} onClick={() => void exportFile(one.name, format)}>{formatName(format)}</button>
            ))}</span>
          </div>
        ))}
      </div>
      {running.value && <p class="hint" role="status">{say("computing")}</p>}
    </Window>
  );
}

// --- the photo ---------------------------------------------------------------------------------------------------------
const measured = signal<{ from: Place; to: Place } | null>(null);
const length = signal("");
export let middleOfView: () => { middle: Place; wide: number } = () => ({ middle: [0, 0], wide: 1 });
export const viewIs = (view: typeof middleOfView): void => { middleOfView = view; };

const readInView = (file: File): void => {
  const { middle, wide } = middleOfView();
  void readPhoto(file, middle, wide).catch(() => tell(say("photo_unreadable"), true));
};
const LENGTH = /^\s*(\d*[.,]?\d+)\s*(mm|cm|m|)\s*$/, METRES: Record<string, number> = { mm: 1e-3, cm: 1e-2, m: 1 };

function PhotoWindow() {
  const unit = scene.value?.display?.length.unit ?? "m", factor = scene.value?.display?.length.factor ?? 1;
  return (
    <Window name="photo" title={say("photo")} onClose={() => { measured.value = null; }}>
      {!photo.value && <p class="hint">{say("photo_hint")}</p>}
      <div class="buttons">
        <label class="button file">{say(photo.value ? "photo_other" : "photo_choose")}
          <input type="file" accept="image/*" onChange={(event) => {
            const file = event.currentTarget.files?.[0];
            if (file) readInView(file);
          }} />
        </label>
        {photo.value && <button type="button" onClick={() => put(null)}>{say("photo_remove")}</button>}
      </div>
      {photo.value && (
        <>
          <label class="slide"><span>{say("photo_opacity")}</span>
            <input type="range" min={0.1} max={1} step={0.05} value={photo.value.opacity} onInput={(event) => put({ ...photo.value!, opacity: Number(event.currentTarget.value) })} />
          </label>
          {measured.value ? (
            <form class="line" onSubmit={(event) => {
              event.preventDefault();
              const [, number = "", own = ""] = LENGTH.exec(length.value) ?? [], value = Number(number.replace(",", ".")) * (METRES[own] ?? 1 / factor);
              if (!(value > 0)) return;
              scaleTo(measured.value!.from, measured.value!.to, value);
              dialog.value = "";
              tell("");
              if (!scene.value?.points.length) fits.value += 1; // what is drawn next is drawn over the photo
            }}>
              <label for="photo-length">{say("photo_length")}</label>
              <input id="photo-length" type="text" inputMode="decimal" required pattern={LENGTH.source} value={length.value} onInput={(event) => { length.value = event.currentTarget.value; }} />
              <span class="unit">{unitText(unit)}</span><button type="submit">{say("apply")}</button>
            </form>
          ) : (
            <div class="buttons"><button type="button" onClick={() => {
              dialog.value = "";
              tell(say("photo_measure"));
              scalePhoto.value = (from, to) => {
                scalePhoto.value = null;
                measured.value = { from, to };
                length.value = spelled(Math.hypot(to[0]! - from[0]!, to[1]! - from[1]!) * factor, 4);
                dialog.value = "photo";
              };
            }}>{say("photo_scale")}</button></div>
          )}
        </>
      )}
    </Window>
  );
}

// --- others ------------------------------------------------------------------------------------------------------------
const KEYS: [string, string][] = [
  ["D  G  E  M", "keys_modes"], ["←  ↑  →  ↓", "keys_arrows"], ["Enter", "keys_enter"], ["Space", "keys_space"], ["Tab", "keys_tab"], ["Esc", "keys_escape"],
  ["Ctrl+←  ↑  →  ↓", "keys_pan"], ["Delete", "keys_delete"], ["Ctrl+Z, Ctrl+Y", "keys_undo"], ["Ctrl+D", "keys_duplicate"], ["Ctrl+S, Ctrl+O", "keys_files"], ["+  −  F", "keys_zoom"], ["P", "keys_play"], ["PageDown  PageUp", "keys_events"], ["T", "keys_text"],
];
function KeysWindow() {
  return (
    <Window name="keys" title={say("keys")}>
      <dl class="key-list">{KEYS.map(([keys, what]) => <div><dt>{keys.split("  ").map((key) => <kbd>{key}</kbd>)}</dt><dd>{say(what)}</dd></div>)}</dl>
    </Window>
  );
}

function DiscardWindow() {
  return (
    <Window name="discard" title={say("unsaved_changes")}>
      <p>{say("discard_question", { name: fileName.value ?? "" })}</p>
      <div class="buttons">
        <button type="button" onClick={() => { const act = onward; dialog.value = ""; void saveNow().then(() => { if (!unsaved.value) act?.(); }); }}>{say("save")}</button>
        <button type="button" onClick={() => { dialog.value = ""; onward?.(); }}>{say("discard")}</button>
      </div>
    </Window>
  );
}

function ByHandWindow() {
  return (
    <Window name="by-hand" title={say("copy_by_hand")} onClose={() => { byHand.value = null; }}>
      <textarea class="by-hand" readonly rows={8} aria-label={say("copy_by_hand")} ref={(area) => area?.select()}>{byHand.value}</textarea>
    </Window>
  );
}

export async function share(): Promise<void> {
  const made = await link();
  await copyText(made, say("link_copied", { count: made.length }));
}

export function Dialogs() {
  return (
    <>
      {dialog.value === "open" && <OpenWindow />}
      {dialog.value === "save" && <SaveWindow />}
      {dialog.value === "export" && <ExportWindow />}
      {dialog.value === "photo" && <PhotoWindow />}
      {dialog.value === "keys" && <KeysWindow />}
      {dialog.value === "discard" && <DiscardWindow />}
      {byHand.value !== null && <ByHandWindow />}
    </>
  );
}
