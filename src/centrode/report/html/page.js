// What is wider than its column gets smaller, on paper as well; the contents show where the reader is.
// Widths in letters' widths (em) of the element itself, whatever its size is now; style sheets do the rest.
const widest = (pieces) => Math.max(0, ...[...pieces].map((one) => one.getBoundingClientRect().width));
const ofFormula = (element) => {
  const size = parseFloat(getComputedStyle(element).fontSize);
  const left = widest(element.querySelectorAll(".left")) / size;
  const right = widest(element.querySelectorAll(".right > math")) / size;
  const running = widest(element.querySelectorAll(".running > p > math")) / size;
  const one = widest(element.querySelectorAll(".one > math")) / size;
  return Math.max(left + (right ? right + 2 : 0), running ? running + 2.4 : 0, one ? one + 0.2 : 0);
};
const ofTable = (table) => {
  const size = parseFloat(getComputedStyle(table).fontSize);
  table.style.width = "min-content";
  const wide = table.getBoundingClientRect().width / size;
  table.style.width = "";
  return wide + 0.1;
};
const fit = () => {
  const formulas = [...document.querySelectorAll(".formulas > div")].map((one) => [one, ofFormula(one)]);
  const tables = [...document.querySelectorAll("table")].map((one) => [one, ofTable(one)]);
  for (const [one, wide] of [...formulas, ...tables]) one.style.setProperty("--wide", Math.max(1, wide).toFixed(2));
};
// What is still wider is scrolled, by keyboard too.
const scroll = () => {
  for (const one of document.querySelectorAll(".table, .formulas, figure > .paper")) {
    if (one.scrollWidth > one.clientWidth + 1) one.tabIndex = 0;
    else one.removeAttribute("tabindex");
  }
};
document.fonts.ready.then(fit).then(scroll);
addEventListener("resize", scroll);

const links = new Map([...document.querySelectorAll("nav a")].map((one) => [one.getAttribute("href").slice(1), one]));
const here = () => {
  const heads = [...document.querySelectorAll("main h2")];
  const passed = heads.filter((one) => one.getBoundingClientRect().top < 0.35 * innerHeight);
  const now = passed.length ? passed[passed.length - 1].id : "";
  for (const [name, link] of links) link.classList.toggle("here", name === now);
};
const contents = document.querySelector("nav details");
if (contents) contents.open = matchMedia("(min-width: 70rem)").matches;
addEventListener("scroll", here, { passive: true });
here();
