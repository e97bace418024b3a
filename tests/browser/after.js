// Looks at a page as its reader has it, uses its charts, and tells the page around it what it saw, as JSON.
addEventListener("load", async () => {
  const pauses = async (count) => { while (count--) await new Promise((done) => setTimeout(done, 60)); };
  const { errors, drawn } = inspected;
  await pauses(4);
  const seen = { width: innerWidth, errors };
  const answers = document.querySelectorAll(".card:first-of-type dd");
  seen.answered = [...document.querySelectorAll(".card")].slice(0, 1).flatMap((card) => [...card.querySelectorAll("dt")]).map((dt) => dt.textContent);
  seen.answered_above = answers.length ? answers[answers.length - 1].getBoundingClientRect().bottom : null;

  // A stretch chosen in one chart over time is that of the others.
  const figures = [...document.querySelectorAll("figure")].filter((figure) => figure.querySelector(".plot"));
  const linked = figures.filter((figure) => JSON.parse(figure.querySelector("script").textContent).link && figure.clientWidth);
  const isPart = (figure) => !figure.querySelector(".below button").hidden;
  if (linked.length > 1) {
    const over = linked[0].querySelector(".u-over"), box = over.getBoundingClientRect();
    const move = (target, kind, share) => target.dispatchEvent(new MouseEvent(kind, {
      bubbles: true, button: 0, clientX: box.left + share * box.width, clientY: box.top + 0.5 * box.height, movementX: 1,
    }));
    move(over, "mouseenter", 0.3);
    move(over, "mousemove", 0.3);
    await pauses(2);
    seen.told = linked[0].querySelector("output").textContent;
    move(over, "mousedown", 0.3);
    move(over, "mousemove", 0.6);
    move(document, "mouseup", 0.6);
    await pauses(3);
    seen.zoomed = linked.slice(0, 2).map(isPart);
    linked[1].querySelector(".below button").click();
    await pauses(3);
    seen.whole = linked.slice(0, 2).map((figure) => !isPart(figure));
  }
  const toggle = document.querySelector(".tools button[aria-pressed]");
  toggle?.click();
  seen.toggled = toggle?.getAttribute("aria-pressed");
  let saved;
  URL.createObjectURL = (blob) => { saved = blob; return "#"; };
  figures[0]?.querySelector(".below button:last-child").click();
  seen.saved = saved && (await saved.text()).split("\n").slice(0, 2);

  // Everything unfolded.
  document.querySelectorAll("details").forEach((one) => { one.open = true; });
  await pauses(4);
  seen.undrawn = figures.filter((figure) => figure.clientWidth && !figure.querySelector("canvas")).length;
  seen.overflow = document.documentElement.scrollWidth - innerWidth;
  seen.smallest = Math.min(...drawn);
  seen.cut = [...document.querySelectorAll(".table")]
    .filter((box) => box.querySelector("table") && box.scrollWidth > box.clientWidth).map((box) => box.textContent.slice(0, 100));
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const parent = texts.currentNode.parentElement, box = parent.getBoundingClientRect();
    if (!texts.currentNode.textContent.trim() || !box.width || !box.height) continue;
    const scale = parent.ownerSVGElement ? parent.getScreenCTM().a : 1;
    seen.smallest = Math.min(seen.smallest, scale * parseFloat(getComputedStyle(parent).fontSize));
  }
  if (window.axe) {
    const { violations } = await axe.run();
    seen.axe = violations.map((found) => `${found.id}: ${found.nodes[0].html.slice(0, 200)}`);
  }
  parent.postMessage(JSON.stringify(seen), "*");
});
