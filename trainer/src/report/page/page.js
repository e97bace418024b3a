// Draws the charts of a page. Each stands as JSON in its figure: groups of series over one horizontal axis each, or cells.
(() => {
  "use strict";
  const HEIGHT = { wide: 300, half: 260, low: 220 };
  const root = document.documentElement;
  const charts = [];
  const ink = (name) => getComputedStyle(root).getPropertyValue("--" + name).trim();
  const figure = (v) => {
    if (v == null || !isFinite(v)) return "";
    const size = Math.abs(v);
    return size !== 0 && (size < 1e-4 || size >= 1e6) ? v.toExponential(2) : String(+v.toPrecision(4));
  };
  const element = (name, attributes, ...children) => {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(...children);
    return made;
  };

  // All groups as one table, ascending: what a group does not have at a row stays undefined, which breaks no line; null does.
  function table(groups) {
    const series = groups.flatMap((group, g) => group.series.map((values, one) => ({ ...values, g, one })));
    const rows = groups.flatMap((group, g) => group.x.map((x, i) => [x, g, i]));
    rows.sort((a, b) => a[0] - b[0] || a[1] - b[1] || a[2] - b[2]);
    const column = (one, of) => rows.map(([, g, i]) => (g === one.g ? of[i] : undefined));
    const columns = [rows.map((row) => row[0])];
    const named = [];
    for (const one of series) {
      for (const [end, of] of one.high ? [["lower", one.y], ["upper", one.high]] : [["", one.y]]) {
        columns.push(column(one, of));
        named.push({ ...one, label: end ? `${one.label}, ${end} end` : one.label, end });
      }
    }
    return { columns, named };
  }

  class Chart {
    constructor(place) {
      this.place = place;
      this.figure = place.parentElement;
      this.spec = JSON.parse(this.figure.querySelector("script").textContent);
      const { columns, named } = this.spec.cells ? { columns: cellColumns(this.spec.cells), named: [] } : table(this.spec.groups);
      this.columns = columns;
      this.named = named;
      this.shown = named.map(() => true);
      this.zoom = null;
      this.tools();
    }

    // What toggles a trace, above; the values under the pointer and what else can be done, below.
    tools() {
      const traces = element("div", { class: "tools" });
      const { groups } = this.spec;
      this.named.forEach((series, s) => {
        const name = groups[series.g].series[series.one].label;
        if (!name || series.end === "upper") return;
        const button = element("button", { type: "button", "aria-pressed": "true" }, element("i", { class: "f-" + series.ink }), name);
        button.onclick = () => {
          const show = !this.shown[s];
          button.setAttribute("aria-pressed", show);
          for (const one of series.end ? [s, s + 1] : [s]) {
            this.shown[one] = show;
            this.plot?.setSeries(one + 1, { show });
          }
        };
        traces.append(button);
      });
      this.values = element("output", {});
      this.whole = element("button", { type: "button", hidden: "" }, "Whole range");
      this.whole.onclick = () => this.unzoom();
      const save = element("button", { type: "button", title: "Download the values of this chart" }, "CSV");
      save.onclick = () => this.save();
      if (traces.childElementCount > 1) this.place.before(traces);
      this.place.after(element("div", { class: "tools below" }, this.values, this.whole, save));
    }

    draw(width) {
      const { spec } = this;
      const theme = { ink: ink("ink"), soft: ink("soft"), rule: ink("rule"), band: ink("band") };
      const axis = (label, extra) => ({
        label, labelSize: 20, labelGap: 2, gap: 4, font: "12px system-ui,sans-serif", labelFont: "12px system-ui,sans-serif",
        stroke: theme.ink, grid: { stroke: theme.rule, width: 1 }, ticks: { stroke: theme.rule, width: 1, size: 4 },
        values: (_, at) => at.map((v) => (v == null ? "" : figure(v))), ...extra,
      });
      const low = { paths: () => null, points: { show: true, size: 3, width: 0, space: 0 } };
      const series = this.named.map((one, s) => {
        const colour = ink(one.ink);
        const shown = { label: one.label, show: this.shown[s], stroke: colour, width: one.ink === "data" ? 3 : 1.4, points: { show: false } };
        // Few points are seen one by one, many as a cloud.
        const size = one.y.length > 200 ? 3 : 7;
        if (one.mark === "dots") return { ...shown, ...low, points: { ...low.points, size, fill: colour + "99", stroke: colour } };
        return one.mark === "area" ? { ...shown, width: 0.5 } : shown;
      });
      const bands = this.named.flatMap((one, s) =>
        one.end === "upper" ? [{ series: [s + 1, s], fill: ink(one.ink) + "38" }] : []);
      const scales = { x: { time: false }, y: {} };
      if (spec.log) scales.x.distr = 3;
      if (spec.cells) {
        scales.x.range = (_, a, b) => (this.zoom ? [a, b] : spec.cells.x);
        scales.y.range = (_, a, b) => (this.zoom ? [a, b] : spec.cells.y);
      }
      const linked = spec.link ? { key: spec.link, filters: { pub: (kind) => kind === "mousemove" || kind === "mouseleave" } } : undefined;
      this.plot?.destroy();
      this.follows = true;
      this.plot = new uPlot({
        width, height: HEIGHT[spec.size], legend: { show: false }, padding: [8, 10, 0, 0], scales, bands,
        series: [{ label: spec.labels[0] }, ...(spec.cells ? [{ show: true, paths: () => null, points: { show: false } }] : series)],
        axes: [axis(spec.labels[0], { size: 30, space: 56, ...(spec.log && { splits: decades }) }), axis(spec.labels[1], { size: 58 })],
        cursor: { sync: linked, drag: { x: true, y: true, uni: 24 }, points: { size: 6 }, dataIdx: (u, s, at) => (s ? this.nearest(u, s, at) : at) },
        hooks: {
          drawClear: [(u) => this.under(u, theme)],
          setCursor: [() => this.tell()],
          setScale: [(u, key) => key === "x" && this.zoomed(u)],
        },
      }, this.columns, this.place);
      const { over } = this.plot;
      over.style.touchAction = "pan-y";
      touch(this.plot, over);
      over.addEventListener("dblclick", () => this.unzoom());
      if (this.zoom) this.plot.setScale("x", this.zoom);
    }

    // The row nearest to the pointer at which a series has a value.
    nearest(u, s, at) {
      const of = u.data[s], x = u.data[0];
      if (of[at] != null) return at;
      let below = at, above = at;
      while (below > 0 && of[below] == null) below--;
      while (above < of.length - 1 && of[above] == null) above++;
      if (of[below] == null) return above;
      if (of[above] == null) return below;
      const here = u.posToVal(u.cursor.left, "x");
      return here - x[below] <= x[above] - here ? below : above;
    }

    // Shaded stretches and cells, beneath the traces.
    under(u, theme) {
      const { ctx, bbox } = u;
      const across = (v) => u.valToPos(v, "x", true), up = (v) => u.valToPos(v, "y", true);
      ctx.save();
      ctx.beginPath();
      ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
      ctx.clip();
      ctx.fillStyle = theme.band + "47";
      for (const [from, to] of this.spec.bands || []) ctx.fillRect(across(from), bbox.top, Math.max(across(to) - across(from), 1), bbox.height);
      const { cells } = this.spec;
      if (cells) {
        const [wide, high] = cells.size, edge = ([low, high], k, n) => low + ((high - low) * k) / n;
        const [hot, cold] = [ink("hot"), ink("cold")];
        cells.v.forEach((v, place) => {
          if (v == null) return;
          const [c, r] = [place % wide, Math.floor(place / wide)];
          const [left, right] = [across(edge(cells.x, c, wide)), across(edge(cells.x, c + 1, wide))];
          const [bottom, top] = [up(edge(cells.y, r, high)), up(edge(cells.y, r + 1, high))];
          ctx.globalAlpha = 0.06 + 0.94 * Math.min(Math.abs(v) / cells.reach, 1);
          ctx.fillStyle = v > 0 ? hot : cold;
          ctx.fillRect(left, top, right - left, bottom - top);
        });
      }
      ctx.restore();
    }

    // Values under the pointer.
    tell() {
      const { plot, spec } = this;
      if (!plot) return;
      const { left, top, idxs } = plot.cursor;
      const inside = left >= 0;
      if (!inside) {
        this.values.replaceChildren();
      } else if (spec.cells) {
        const { x, y, size: [wide, high], v, unit } = spec.cells;
        const [at, up] = [plot.posToVal(left, "x"), plot.posToVal(top, "y")];
        const cell = (value, [a, b], n) => Math.floor(((value - a) / (b - a)) * n);
        const value = v[cell(up, y, high) * wide + cell(at, x, wide)];
        this.values.replaceChildren(`${figure(at)}, ${figure(up)}: ${value == null ? "no rows" : figure(value) + " " + unit}`);
      } else {
        const shown = this.named.map((one, s) => [one, s, idxs?.[s + 1]]).filter(([one, s, at]) => one.label && this.shown[s] && at != null);
        const values = shown.map(([one, s, at]) => element("span", {}, " ", element("i", { class: "f-" + one.ink }), figure(plot.data[s + 1][at])));
        this.values.replaceChildren("at " + figure(plot.posToVal(left, "x")), ...values);
      }
    }

    // A chart that shows a part of its range tells the charts that are linked with it, unless another chart has told it so.
    zoomed(u) {
      const { min, max } = u.scales.x, [first, last] = this.ends();
      const isWhole = min == null || (min <= first && max >= last);
      this.zoom = isWhole ? null : { min, max };
      this.whole.hidden = isWhole;
      const follows = this.follows;
      this.follows = false;
      if (follows || !this.spec.link) return;
      for (const other of charts) {
        if (other !== this && other.spec.link === this.spec.link) other.follow(isWhole ? -Infinity : min, isWhole ? Infinity : max);
      }
    }

    // Shows a stretch, as far as this chart has it.
    follow(from, to) {
      const [first, last] = this.ends(), [min, max] = [Math.max(from, first), Math.min(to, last)];
      const now = this.plot?.scales.x;
      if (!now || min >= max || (now.min === min && now.max === max)) return;
      this.follows = true;
      this.plot.setScale("x", { min, max });
    }

    ends() {
      const all = this.columns[0];
      return this.spec.cells ? this.spec.cells.x : [all[0], all[all.length - 1]];
    }

    unzoom() {
      this.plot.setData(this.columns, true);
    }

    save() {
      const cell = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
      const heads = this.spec.cells ? [...this.spec.labels, `mean residual (${this.spec.cells.unit})`] : [this.spec.labels[0], ...this.named.map((one) => one.label || this.spec.labels[1])];
      const columns = this.spec.cells ? cellTable(this.spec.cells) : this.columns;
      const rows = columns[0].map((_, i) => columns.map((column) => column[i] ?? "").join(","));
      const link = element("a", { download: this.spec.name + ".csv" });
      link.href = URL.createObjectURL(new Blob([[heads.map(cell).join(","), ...rows].join("\n") + "\n"], { type: "text/csv" }));
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    }
  }

  const decades = (_, __, min, max) => {
    const [first, last] = [Math.floor(Math.log10(min)), Math.ceil(Math.log10(max))];
    return Array.from({ length: last - first + 1 }, (_, k) => 10 ** (first + k));
  };
  const cellColumns = ({ x, y }) => [[x[0], x[1]], [y[0], y[1]]];
  const cellTable = ({ x, y, size: [wide, high], v }) => {
    const middle = ([a, b], k, n) => a + ((b - a) * (k + 0.5)) / n;
    const full = v.map((value, place) => [middle(x, place % wide, wide), middle(y, Math.floor(place / wide), high), value]).filter((row) => row[2] != null);
    return [0, 1, 2].map((column) => full.map((row) => row[column]));
  };

  // One finger reads values, two stretch and move the horizontal axis.
  function touch(u, over) {
    let begin = null;
    const at = (event) => [...event.touches].map((finger) => finger.clientX - over.getBoundingClientRect().left);
    over.addEventListener("touchstart", (event) => {
      const fingers = at(event);
      begin = fingers.length === 2 ? fingers.map((x) => u.posToVal(x, "x")) : null;
    }, { passive: true });
    over.addEventListener("touchmove", (event) => {
      const fingers = at(event);
      if (fingers.length === 1) {
        u.setCursor({ left: fingers[0], top: event.touches[0].clientY - over.getBoundingClientRect().top });
      } else if (begin && Math.abs(fingers[1] - fingers[0]) > 8) {
        event.preventDefault();
        const perPixel = (begin[1] - begin[0]) / (fingers[1] - fingers[0]);
        const min = begin[0] - fingers[0] * perPixel;
        if (perPixel > 0) u.setScale("x", { min, max: min + over.clientWidth * perPixel });
      }
    }, { passive: false });
  }

  const width = (place) => Math.floor(place.clientWidth);
  const drawAll = (of) => charts.forEach((chart) => {
    const wide = of(chart.place);
    if (wide > 0) chart.draw(wide);
  });
  const sizes = new ResizeObserver((entries) => requestAnimationFrame(() => entries.forEach(({ target }) => {
    const chart = charts.find((one) => one.place === target), wide = width(target);
    if (wide > 0 && chart.plot?.width !== wide) chart.draw(wide);
  })));
  for (const place of document.querySelectorAll("figure .plot")) charts.push(new Chart(place));
  drawAll(width);
  for (const { place } of charts) sizes.observe(place);
  for (const folded of document.querySelectorAll("details")) {
    folded.addEventListener("toggle", () => charts.forEach((chart) => {
      if (!chart.plot && width(chart.place) > 0) chart.draw(width(chart.place));
    }));
  }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => drawAll(width));

  // On paper everything is open, in dark ink.
  let folded = [];
  addEventListener("beforeprint", () => {
    folded = [...document.querySelectorAll("details:not([open])")];
    folded.forEach((one) => { one.open = true; });
    root.classList.add("paper");
    drawAll((place) => Math.min(width(place), 640));
  });
  addEventListener("afterprint", () => {
    folded.forEach((one) => { one.open = false; });
    root.classList.remove("paper");
    drawAll(width);
  });
  // A link to what is folded unfolds it.
  const unfold = () => {
    const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    for (let one = target; one; one = one.parentElement) if (one.tagName === "DETAILS") one.open = true;
    if (target) target.scrollIntoView();
  };
  addEventListener("hashchange", unfold);
  unfold();
})();
