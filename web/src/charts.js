// Figures over steps, with the step that the picture shows marked in each. Where a few steps are far above all others the chart
// ends below them, so that the others are seen too: these steps are marked at its top, and the highest is named.

import uPlot from 'uplot';
import { colour, element } from './dom.js';
import { explained } from './words.js';

const HEIGHT = 260;
/** Lines whose figures differ by so much are offered on a logarithmic axis. */
const DECADES = 100;
/** Steps between the numbers of an axis of what has no halves: frames, pairs. */
const WHOLE = Array.from({ length: 16 }, (_, power) => [1, 2, 5].map((digit) => digit * 10 ** power)).flat();
const HEIGHTS = { cut: 'Clipped', all: 'Linear', logarithmic: 'Logarithmic' };

/** A figure with its chart; `chosen` is told the number of a step that is clicked or dragged to. */
export class Chart {
  constructor(facts, chosen) {
    this.facts = facts;
    this.chosen = chosen;
    this.marker = element('div', { className: 'marker', hidden: true });
    this.outliers = element('div', { className: 'outliers' });
    this.box = element('div', { className: 'chart' });
    this.offerHeights();
    const save = element('button', { type: 'button', className: 'quiet', onclick: () => this.save() }, 'Save as SVG');
    this.figure = element('figure', {}, element('figcaption', {}, element('h3', {}, ...explained(facts.title)), this.heights, save), this.box);
    this.resized = new ResizeObserver(() => this.plot?.setSize({ width: this.box.clientWidth, height: HEIGHT }));
  }

  /** Decides how high the chart is, and offers what else makes sense. */
  offerHeights() {
    const { lines, ceiling, logarithmic } = this.facts;
    const positive = lines.flatMap(({ values }) => values.filter((value) => value > 0));
    const [least, most] = positive.reduce(([least, most], value) => [Math.min(least, value), Math.max(most, value)], [Infinity, 0]);
    const offered = Object.keys(HEIGHTS).filter((height) => height === 'all'
      || (height === 'cut' ? ceiling !== null : logarithmic || ceiling !== null || most > DECADES * least));
    this.height = logarithmic ? 'logarithmic' : offered[0];
    const buttons = offered.map((height) => element('button', {
      type: 'button', 'aria-pressed': String(height === this.height), onclick: ({ target }) => {
        this.height = height;
        buttons.forEach((button) => button.setAttribute('aria-pressed', String(button === target)));
        this.draw();
      },
    }, HEIGHTS[height]));
    this.heights = element('div', { className: 'heights', role: 'group', 'aria-label': 'Height', hidden: offered.length === 1 }, ...buttons);
  }

  /** Draws the chart, anew where colours or the height have changed; the figure must be on the page. */
  draw() {
    this.plot?.destroy();
    const { x, lines, unit, along, ceiling } = this.facts;
    const logarithmic = this.height === 'logarithmic';
    const top = (most) => 1.05 * (this.height === 'cut' ? ceiling : most > 0 ? most : 1);
    const axis = { stroke: colour('muted'), grid: { stroke: colour('line'), width: 1 }, ticks: { stroke: colour('line'), width: 1 }, font: '12px system-ui, sans-serif' };
    const single = lines.length === 1;
    const counts = lines.every(({ values }) => values.every((value) => value === null || Number.isInteger(value)));
    const xAxis = { ...axis, incrs: WHOLE, ...(x.length === 1 && { splits: [x[0]] }) };
    const yAxis = { ...axis, ...(counts && !logarithmic && { incrs: WHOLE }), size: 64, label: unit, labelSize: 18, labelFont: axis.font };
    const options = {
      width: this.box.clientWidth,
      height: HEIGHT,
      // One step alone is in the middle.
      scales: { x: { time: false, ...(x.length === 1 && { range: [x[0] - 1, x[0] + 1] }) }, y: logarithmic ? { distr: 3 } : { range: (_, __, most) => [0, top(most)] } },
      axes: [xAxis, yAxis],
      // Dragging moves the picture; it does not zoom.
      cursor: { drag: { x: false, y: false }, points: { size: 6 } },
      // The legend has colour and dash of each line.
      legend: { markers: { width: 2, dash: (_, i) => ['solid', 'dashed', 'dotted'][Math.max(0, [0, 6, 2].indexOf(lines[i - 1]?.dash?.[0] ?? 0))] } },
      series: [
        { label: along },
        ...lines.map((line) => ({
          label: element('span', {}, ...explained(line.name)),
          stroke: single ? colour('red') : line.colour,
          fill: single ? colour('red-wash') : undefined,
          width: 1.5,
          dash: line.dash,
          points: { show: x.length === 1 },
          value: (_, value) => (value == null ? '' : this.said(value)),
        })),
      ],
      // Where nobody points at a step, the legend is about the one that the picture shows.
      hooks: { setSize: [() => this.place()], setCursor: [(plot) => plot.cursor.idx == null && this.tell()] },
    };
    const values = lines.map((line) => line.values.map((value) => (logarithmic && !(value > 0) ? null : value)));
    this.plot = new uPlot(options, [x, ...values], this.box);
    this.showOutliers(top());
    this.plot.over.append(this.marker, this.outliers);
    this.plot.over.addEventListener('pointerdown', (event) => this.choose(event));
    this.plot.over.addEventListener('pointermove', (event) => event.buttons & 1 && this.choose(event));
    this.resized.observe(this.box);
    this.place();
  }

  said(value) {
    return `${Number(value.toPrecision(4)).toLocaleString('en-GB', { maximumFractionDigits: 6 })} ${this.facts.unit}`;
  }

  /** A mark for each step that is above a clipped chart, with the highest line there; the highest of all is named. */
  showOutliers(top) {
    const { x, lines, along } = this.facts;
    const steps = this.height === 'cut' ? [...x.keys()] : [];
    const highest = steps.map((step) => lines.reduce((most, line) => (line.values[step] > most.values[step] ? line : most)).values[step]);
    const most = Math.max(...highest);
    this.outliers.replaceChildren(...steps.filter((step) => highest[step] > top).map((step) => {
      const line = lines.find(({ values }) => values[step] === highest[step]);
      const said = this.said(highest[step]);
      const mark = element('i', { title: `${along} ${x[step]}: ${lines.length > 1 ? `${line.name}, ` : ''}${said}` });
      mark.style.color = lines.length > 1 ? line.colour : colour('red');
      mark.dataset.number = x[step];
      if (highest[step] === most) mark.append(element('b', {}, `${along} ${x[step]}: ${said}`));
      return mark;
    }));
  }

  choose(event) {
    const left = event.clientX - this.plot.over.getBoundingClientRect().left;
    this.chosen(this.facts.x[this.plot.posToIdx(left)]);
  }

  /** Marks a step. */
  mark(number) {
    this.number = number;
    this.place();
  }

  place() {
    for (const mark of this.plot ? this.outliers.children : []) {
      const left = this.plot.valToPos(+mark.dataset.number, 'x');
      mark.style.left = `${left}px`;
      mark.classList.toggle('late', 2 * left > this.plot.over.clientWidth);
    }
    this.marker.hidden = this.number === undefined || !this.plot;
    if (this.marker.hidden) return;
    this.marker.style.left = `${this.plot.valToPos(this.number, 'x')}px`;
    this.tell();
  }

  tell() {
    const idx = this.facts.x.indexOf(this.number);
    if (idx >= 0) this.plot.setLegend({ idx }, false);
  }

  /** The chart as pliant drew it for a paper. */
  save() {
    const link = element('a', {
      href: URL.createObjectURL(new Blob([this.facts.svg], { type: 'image/svg+xml' })),
      download: `${this.facts.title.replace(/[^\p{L}\p{N}]+/gu, '-').replace(/^-|-$/g, '')}.svg`,
    });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  leave() {
    this.resized.disconnect();
    this.plot?.destroy();
  }
}
