// The workbench: puts the page together.
import { batch, effect } from "@preact/signals";
import { render } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { CamStage } from "./cam";
import { busy, online } from "./connection";
import { Dialogs, dialog, download, fresh, openDropped, saveNow, share, viewIs } from "./dialogs";
import { Icon } from "./icons";
import { PanelCard, ReadinessView } from "./panels";
import { Player, step, toggle } from "./player";
import { SelectionCard, duplicateSelected, removeSelected } from "./selection_card";
import { Stage } from "./stage";
import { type Mode, SPHERE, editing, fileName, follow, hello, keepNow, mode, motion, place, playing, problems, redo, said, scene, shows, snapping, speak, steps, tell, text, undo, unsaved, write } from "./state";
import { TextPane } from "./text_pane";
import { refusal } from "./token";
import { language, say } from "./words";

let stage: Stage | null = null;
const MODES: Mode[] = ["draw", "guide", "edit", "move"];

function TopBar() {
  const title = scene.value?.title || fileName.value || say("untitled");
  return (
    <header class="top">
      <div class="title">
        <h1 title={title}>{title}</h1>
        <p class="subtitle">{fileName.value ? `${fileName.value}${unsaved.value ? ` · ${say("unsaved")}` : ""}` : say("kept_here")}</p>
      </div>
      <div class="actions">
        <button type="button" data-do="new" onClick={fresh}>{say("new")}</button>
        <button type="button" data-do="open" onClick={() => { dialog.value = "open"; }}>{say("open")}</button>
        <button type="button" data-do="save" onClick={() => void saveNow()}>{say("save")}</button>
        <button type="button" data-do="export" onClick={() => { dialog.value = "export"; }}>{say("export")}</button>
        <button type="button" data-do="link" onClick={() => void share()}>{say("copy_link")}</button>
        <span class="group">
          <button type="button" class="icon-button" data-do="undo" disabled={!steps.value.undo} aria-label={say("undo")} title={say("undo")} onClick={undo}><Icon name="undo" /></button>
          <button type="button" class="icon-button" data-do="redo" disabled={!steps.value.redo} aria-label={say("redo")} title={say("redo")} onClick={redo}><Icon name="redo" /></button>
        </span>
        <button type="button" data-do="text" aria-pressed={editing.value} onClick={() => { editing.value = !editing.value; }}>{say("text")}{problems.value.length && (scene.value?.points.length || scene.value?.kind === "cam") ? <span class="count">{problems.value.length}</span> : null}</button>
        <select class="language" aria-label={say("language")} value={language.value} onChange={(event) => speak(event.currentTarget.value)}>
          {(hello.value?.languages ?? []).map((one) => <option value={one.code} lang={one.code}>{one.name}</option>)}
        </select>
      </div>
    </header>
  );
}

function Tools() {
  const draws = scene.value?.draws !== false;
  const press = (on: boolean, name: string, act: () => void) => (
    <button type="button" class="icon-button" aria-pressed={on} data-do={name} aria-label={say(name)} title={say(name)} onClick={act}><Icon name={name} /></button>
  );
  const button = (icon: string, name: string, act: () => void) => (
    <button type="button" class="icon-button" data-do={name} aria-label={say(name)} title={say(name)} onClick={act}><Icon name={icon} /></button>
  );
  return (
    <div class="tools" role="toolbar" aria-label={say("tools")}>
      <div class="modes" role="group" aria-label={say("modes")}>
        {MODES.map((one) => {
          const barred = !draws && (one === "draw" || one === "guide"), why = barred ? say("not_on_sphere") : say(`mode_${one}_hint`);
          return (
            <button type="button" aria-pressed={mode.value === one} aria-disabled={barred} data-mode={one} title={why}
              onClick={() => { if (barred) tell(why, true); else batch(() => { mode.value = one; tell(why); }); }}><Icon name={one} /><span>{say(`mode_${one}`)}</span></button>
          );
        })}
      </div>
      <div class="views">
        {button("fit", "fit", () => stage?.fit())}
        {button("plus", "zoom_in", () => stage?.zoom(1.25))}
        {button("minus", "zoom_out", () => stage?.zoom(0.8))}
        {press(snapping.value, "snap", () => { snapping.value = !snapping.value; })}
        {press(shows.value.grid !== false, "grid", () => { shows.value = { ...shows.value, grid: shows.value.grid === false }; })}
        {button("photo", "photo", () => { dialog.value = "photo"; })}
        {button("keys", "keys", () => { dialog.value = "keys"; })}
      </div>
    </div>
  );
}

function StageView() {
  const holder = useRef<HTMLDivElement>(null);
  useEffect(() => {
    stage = new Stage(holder.current!);
    viewIs(() => ({ middle: stage!.plane.middle, wide: (0.7 * stage!.plane.wide) / stage!.plane.scale }));
  }, []);
  const cam = scene.value?.kind === "cam", empty = scene.value !== null && !cam && !scene.value.points.length;
  return (
    <div class={`moving stage-card mode-${mode.value}`}>
      {!cam && <Tools />}
      <div class="stage-area">
        <div class="stage-holder" ref={holder} hidden={cam} />
        {cam && <CamStage />}
        {empty && (
          <>
            <p class="welcome">{say(scene.value?.kind === "sphere" ? "empty_sphere" : "empty_stage")}</p>
            {scene.value?.kind === "plane" && <button type="button" class="begin-sphere" data-do="sphere" onClick={() => write(SPHERE)}>{say("draw_on_sphere")}</button>}
          </>
        )}
      </div>
      <p class={said.value.bad ? "said bad" : "said"} role="status" id="said">{said.value.text}</p>
      <Player />
    </div>
  );
}

function Lost() {
  if (online.value !== "lost") return null;
  return <div class="lost" role="alert"><b>{say("server_gone")}</b> {say("server_gone_repair")} <button type="button" onClick={() => download(text.value, fileName.value ?? "mechanism.toml")}>{say("download")}</button></div>;
}

function App() {
  if (!hello.value) return <main class="opening" aria-busy="true">{online.value === "lost" ? <p class="refusal">{refusal || "centrode"}</p> : said.value.bad && <p class="refusal" role="alert">{said.value.text}</p>}</main>;
  return (
    <div class={editing.value ? "bench live with-text" : "bench live"}>
      <TopBar />
      <Lost />
      <main>
        {editing.value && <TextPane />}
        <StageView />
        <div class="right">
          {scene.value?.kind !== "cam" && (
            <aside class="side" aria-label={say("selection")}>
              <SelectionCard />
              <section class="card ready" aria-label={say("readiness")}>
                <h2>{say("readiness")}</h2>
                <ReadinessView />
              </section>
            </aside>
          )}
          <PanelCard />
        </div>
      </main>
      <Dialogs />
      <div class={busy.value ? "busy on" : "busy"} aria-hidden="true" />
    </div>
  );
}

// Keys of the page: letters where nobody writes, and what all programs share.
addEventListener("keydown", (event) => {
  const target = event.target as HTMLElement, writes = target.closest?.("input:not([type=checkbox]):not([type=range]), textarea, select, .cm-editor") !== null && target.closest !== undefined;
  if (event.ctrlKey || event.metaKey) {
    const key = event.key.toLowerCase(), acts: Record<string, () => void> = {
      z: event.shiftKey ? redo : undo, y: redo, s: () => void saveNow(), o: () => { dialog.value = "open"; }, d: () => void duplicateSelected(),
    };
    if (!acts[key] || (writes && key !== "s" && key !== "o")) return;
    event.preventDefault();
    acts[key]!();
    return;
  }
  if (writes || event.altKey || dialog.value || target.closest?.("dialog, [role=tablist]")) return;
  const acts: Record<string, () => void> = {
    d: () => { mode.value = "draw"; }, g: () => { mode.value = "guide"; }, e: () => { mode.value = "edit"; }, m: () => { mode.value = "move"; },
    f: () => stage?.fit(), "+": () => stage?.zoom(1.25), "=": () => stage?.zoom(1.25), "-": () => stage?.zoom(0.8), p: toggle, t: () => { editing.value = !editing.value; },
    Delete: () => void removeSelected(), Backspace: () => void removeSelected(), ",": () => step(-1), ".": () => step(1), "?": () => { dialog.value = "keys"; },
  };
  const act = acts[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!act || (scene.value?.draws === false && "dg".includes(event.key))) return;
  event.preventDefault();
  act();
});
// A browser would leave the page for a file that is dropped on it.
addEventListener("dragover", (event) => {
  if (event.dataTransfer?.types.includes("Files")) event.preventDefault();
});
addEventListener("drop", (event) => {
  const file = event.dataTransfer?.files[0];
  if (!file) return;
  event.preventDefault();
  void openDropped(file);
});
addEventListener("hashchange", () => void follow());
addEventListener("beforeunload", keepNow);
effect(() => {
  if (scene.value?.draws === false && (mode.value === "draw" || mode.value === "guide")) mode.value = "move";
});
effect(() => {
  if (mode.value === "move") return;
  playing.value = false; // what is drawn is the initial position
  if (scene.peek()?.kind !== "cam") place.value = motion.peek()?.start ?? 0;
});
effect(() => {
  document.title = `${unsaved.value ? "• " : ""}${scene.value?.title || fileName.value || "centrode"}`;
});

render(<App />, document.getElementById("app")!);
