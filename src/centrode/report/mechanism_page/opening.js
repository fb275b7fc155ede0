// Puts the page together.
const page = JSON.parse(document.getElementById("page-data").textContent);
const model = new Model(page);
const find = (name) => document.querySelector(name);
const announcement = find("#said");
const say = (told, bad = false) => {
  announcement.textContent = told;
  announcement.classList.toggle("bad", bad);
};

const { drawing } = page;
let curves = null, numbers = null;
const stage = new MechanismStage(find(".moving"), {
  model,
  tell: (told) => say(told),
  moved: () => {
    if (curves) curves.show();
    if (numbers) numbers.show();
  },
  samples: model.frame.samples,
  start: model.start,
  axes: page.program.axes.length,
  loop: false,
  wide: within(10 * find(".moving").clientWidth, 3600, 9000),
  label: page.words.picture,
  points: drawing.points.map((point) => ({ ...point, at: [] })),
  bodies: drawing.bodies,
  grounds: [],
  shapes: [],
  rings: drawing.rings.map((ring) => ({ ...ring, ...ringOf(model, ring) })),
  tracks: drawing.tracks,
  support: drawing.support,
  words: page.words,
  view: drawing.view,
  centre: [0, 0],
  radius: 1,
  size: [0, 0],
});
curves = new Curves(find(".curves"), stage, model);
curves.choose(page.chosen);
numbers = new Numbers(find("details.table-of-numbers"), stage, model);

const copy = (told, done) => {
  const shown = () => {
    // where a browser does not let pages copy, the text is shown to be copied by hand
    const dialog = find("#by-hand"), area = dialog.querySelector("textarea");
    area.value = told;
    dialog.showModal();
    area.select();
  };
  if (!navigator.clipboard) shown();
  else navigator.clipboard.writeText(told).then(() => say(done), shown);
};
const settle = () => stage.settle();
if (model.parameters.length) new Sliders(find(".dimensions"), model, settle);
new Statuses(find(".statuses"), find(".strip"), model, copy);

const boxes = document.querySelectorAll('.controls input[type="checkbox"]');
const link = new StateLink(model, stage, curves, boxes);
const follow = () => {
  const told = location.hash;
  if (told.startsWith("#s=")) {
    const wrong = link.take(told.slice(3));
    say(wrong || page.words.taken, Boolean(wrong));
  }
};
find('[data-do="copy-link"]').addEventListener("click", () => {
  const address = `${location.href.split("#")[0]}#s=${link.text}`;
  history.replaceState(null, "", address);
  copy(address, page.words.link_copied);
});
find('[data-do="csv"]').addEventListener("click", () => copy(tableOf(model), page.words.table_copied));
find('[data-do="fit"]').addEventListener("click", () => stage.fit());
addEventListener("hashchange", follow);
addEventListener("keydown", (event) => {
  if (!(event.ctrlKey || event.metaKey) || event.shiftKey || event.key.toLowerCase() !== "z" || event.target.matches('input[type="text"], textarea')) return;
  event.preventDefault();
  model.undo();
  stage.settle();
});
new ResizeObserver(() => stage.widen(find(".moving .paper").clientWidth)).observe(find(".moving .paper"));

// On paper stand the dimensions as they are now.
const printDimensions = () => {
  const cells = model.parameters.map((one, k) => {
    const unit = model.unit(one);
    return [element("td", {}, page.names[one.path] ?? one.path),
      element("td", { className: "n" }, withUnit(model.spelling.number(model.values[k] * unit.factor, 6), unit.label))];
  });
  const rows = Array.from({ length: Math.ceil(cells.length / 4) }, (_, k) => element("tr", {}, ...cells.slice(4 * k, 4 * k + 4).flat()));
  find(".printed tbody").replaceChildren(...rows);
  find(".printed .place").textContent = model.place(within(Math.round(stage.place), 0, model.last));
};
addEventListener("beforeprint", printDimensions);
follow();
