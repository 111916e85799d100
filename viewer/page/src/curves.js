// The curves of the paper's figures 7 and 8, by view, with a cursor at the view that is shown.
import uPlot from 'uplot';

const kCurves = [
  { key: 'tried', name: 'positions tried' },
  { key: 'fitness', name: 'fitness' },
  { key: 'quality', name: 'mean quality' },
  { key: 'area_m2', name: 'Occupied area, m²' },
];
const kHeight = 104;
const kColours = ['#6ab7ff', '#ffb35c'];

export class Curves {
  /// chosen(view): somebody has clicked there.
  constructor(element, chosen) {
    this.element = element;
    this.chosen = chosen;
    this.view = 0;
    this.plots = [];
    new ResizeObserver(() => this.resize()).observe(element);
  }

  /// runs: [{name, rows}], one or two.
  set(runs) {
    const names = runs.map((run) => run.name).join('\n');
    if (this.names !== names) {
      this.names = names;
      for (const plot of this.plots) plot.destroy();
      this.plots = kCurves.map((curve) => this.make(curve, runs));
    }
    const length = Math.max(1, ...runs.map((run) => run.rows.length));
    const views = Array.from({ length }, (_, i) => i + 1);
    this.plots.forEach((plot, i) => {
      plot.setData([views, ...runs.map(({ rows }) => views.map((view) => rows[view - 1]?.[kCurves[i].key] ?? null))]);
    });
  }

  make(curve, runs) {
    const axis = { stroke: '#aab6c4', grid: { stroke: '#2a3440', width: 1 }, ticks: { stroke: '#2a3440' }, font: '11px sans-serif' };
    const plot = new uPlot({
      width: Math.max(200, this.element.clientWidth),
      height: kHeight,
      title: curve.name,
      legend: { show: false },
      scales: { x: { time: false } },
      cursor: { y: false, drag: { x: false, y: false } },
      axes: [{ ...axis, size: 26, gap: 2 }, { ...axis, size: 50, space: 22 }],
      series: [{}, ...runs.map((run, i) => ({ label: run.name, stroke: kColours[i], width: 1.5, points: { show: false } }))],
      hooks: { draw: [(drawn) => this.draw_cursor(drawn)] },
    }, [[1], ...runs.map(() => [null])], this.element);
    plot.over.addEventListener('click', () => {
      const { left } = plot.cursor;
      if (left >= 0) this.chosen(Math.round(plot.posToVal(left, 'x')));
    });
    return plot;
  }

  set_view(view) {
    if (view === this.view) return;
    this.view = view;
    for (const plot of this.plots) plot.redraw(false);
  }

  draw_cursor(plot) {
    if (this.view < 1) return;
    const x = plot.valToPos(this.view, 'x', true);
    const { ctx, bbox } = plot;
    if (x < bbox.left || x > bbox.left + bbox.width) return;
    ctx.save();
    ctx.strokeStyle = '#ffffff';
    ctx.lineWidth = 1;
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.restore();
  }

  resize() {
    const width = this.element.clientWidth;
    if (width < 50) return;
    for (const plot of this.plots) if (plot.width !== width) plot.setSize({ width, height: kHeight });
  }
}
