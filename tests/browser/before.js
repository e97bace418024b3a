// Runs before everything else of a page: what goes wrong, and the size of the letters that are drawn.
window.inspected = { errors: [], drawn: [] };
addEventListener("error", (event) => inspected.errors.push(event.message));
addEventListener("unhandledrejection", (event) => inspected.errors.push(String(event.reason)));
for (const kind of ["error", "warn"]) console[kind] = (...words) => inspected.errors.push(words.join(" "));
const fillText = CanvasRenderingContext2D.prototype.fillText;
CanvasRenderingContext2D.prototype.fillText = function (...words) {
  inspected.drawn.push(parseFloat(this.font.match(/([\d.]+)px/)[1]) / devicePixelRatio);
  return fillText.apply(this, words);
};
