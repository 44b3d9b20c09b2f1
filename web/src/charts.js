// Figures over steps, with the step that the picture shows marked in each.

import uPlot from 'uplot';
import { colour, element } from './dom.js';

const HEIGHT = 260;

/** A figure with its chart; `chosen` is told the number of a step that is clicked or dragged to. */
export class Chart {
  constructor(facts, chosen) {
    this.facts = facts;
    this.chosen = chosen;
    this.marker = element('div', { className: 'marker', hidden: true });
    this.box = element('div', { className: 'chart' });
    const save = element('button', { type: 'button', className: 'quiet', onclick: () => this.save() }, 'Save as SVG');
    this.figure = element('figure', {}, element('figcaption', {}, element('h3', {}, facts.title), save), this.box);
    this.resized = new ResizeObserver(() => this.plot?.setSize({ width: this.box.clientWidth, height: HEIGHT }));
  }

  /** Draws the chart, anew where colours have changed; the figure must be on the page. */
  draw() {
    this.plot?.destroy();
    const { x, lines, unit, along, logarithmic } = this.facts;
    const axis = { stroke: colour('muted'), grid: { stroke: colour('line'), width: 1 }, ticks: { stroke: colour('line'), width: 1 }, font: '12px system-ui, sans-serif' };
    const single = lines.length === 1;
    const options = {
      width: this.box.clientWidth,
      height: HEIGHT,
      scales: { x: { time: false }, y: logarithmic ? { distr: 3 } : { range: (_, __, most) => [0, most > 0 ? most * 1.05 : 1] } },
      axes: [axis, { ...axis, size: 64, label: unit, labelSize: 18, labelFont: axis.font }],
      // Dragging moves the picture; it does not zoom.
      cursor: { drag: { x: false, y: false }, points: { size: 6 } },
      // The legend has colour and dash of each line.
      legend: { markers: { width: 2, dash: (_, i) => ['solid', 'dashed', 'dotted'][Math.max(0, [0, 6, 2].indexOf(lines[i - 1]?.dash?.[0] ?? 0))] } },
      series: [
        { label: along },
        ...lines.map((line) => ({
          label: line.name,
          stroke: single ? colour('red') : line.colour,
          fill: single ? colour('red-wash') : undefined,
          width: 1.5,
          dash: line.dash,
          points: { show: x.length === 1 },
          value: (_, value) => (value == null ? '' : `${Number(value.toPrecision(4)).toLocaleString('en-GB', { maximumFractionDigits: 6 })} ${unit}`),
        })),
      ],
      // Where nobody points at a step, the legend is about the one that the picture shows.
      hooks: { setSize: [() => this.place()], setCursor: [(plot) => plot.cursor.idx == null && this.tell()] },
    };
    const values = lines.map((line) => line.values.map((value) => (logarithmic && !(value > 0) ? null : value)));
    this.plot = new uPlot(options, [x, ...values], this.box);
    this.plot.over.append(this.marker);
    this.plot.over.addEventListener('pointerdown', (event) => this.choose(event));
    this.plot.over.addEventListener('pointermove', (event) => event.buttons & 1 && this.choose(event));
    this.resized.observe(this.box);
    this.place();
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
