// Draws feedrate, velocity, acceleration, jerk and deviation over time, with their limits and one cursor.
'use strict';

const AXIS_COLOURS = ['#c8352b', '#1f6fb5', '#2b8a3e', '#8a4fbf', '#b36b00', '#0f8a8a', '#b0307a', '#6b7a1a', '#555f6e'];

function rgb(colour) { return `rgb(${colour})`; }

class Charts {
  constructor(element, meta, motions, pick) {
    Object.assign(this, { element, meta, motions, pick });
    this.chosen = 0;
    this.duration = Math.max(1e-9, ...motions.map(motion => motion.duration));
    this.range = [0, this.duration];
    this.plots = [];
    this.build();
  }
  kinds() {
    const { meta } = this, unit = meta.axes.every(axis => axis.unit === meta.axes[0].unit) ? meta.axes[0].unit : 'unit';
    return [
      { title: 'feedrate, mm/s', curve: 's', height: 136 },
      { title: `velocity, ${unit}/s`, curve: 'v', limits: meta.velocity, height: 122 },
      { title: `acceleration, ${unit}/s²`, curve: 'a', limits: meta.acceleration, height: 122 },
      { title: `jerk, ${unit}/s³`, curve: 'j', limits: meta.jerk, height: 122 },
      { title: 'deviation, µm', curve: 'd', height: 110 },
    ];
  }
  width() { return Math.max(260, this.element.clientWidth - 4); }
  build() {
    for (const plot of this.plots) plot.destroy();
    this.element.textContent = '';
    const dark = matchMedia('(prefers-color-scheme: dark)').matches;
    const ink = { stroke: dark ? '#a3aebd' : '#55606f', grid: { stroke: dark ? '#29303a' : '#e6eaf0', width: 1 }, ticks: { show: false } };
    const inUse = this.meta.axes.map((_, k) => k).filter(k => this.moves(k));
    this.plots = this.kinds().map(kind => this.plot(kind, ink, inUse));
    this.draw();
  }
  // Whether an axis moves at all, in the motion that is looked at.
  moves(k) {
    const motion = this.motions[this.chosen];
    if (motion.n === 0) return false;
    const [low, high] = motion.extremes('v', k, 0, motion.duration);
    return low !== 0 || high !== 0;
  }
  plot(kind, ink, inUse) {
    const digits = kind.curve === 'd' ? 3 : 4;
    const value = (u, v) => (v == null ? '' : Number(v.toPrecision(digits + 3)).toString());
    const series = [{ label: 'time', value: (u, v) => (v == null ? '' : v.toFixed(4) + ' s') }];
    let curves;
    if (kind.curve === 's') {
      curves = this.motions.map((motion, i) => ({ motion, curve: 's', k: 0, label: motion.facts.name, stroke: rgb(METHOD_COLOURS[i % METHOD_COLOURS.length]), width: i === this.chosen ? 1.6 : 1 }));
      curves.push({ motion: this.motions[this.chosen], curve: 'f', k: 0, label: 'programmed', stroke: '#8a93a0', dash: [4, 3], width: 1 });
    } else if (kind.curve === 'd') {
      curves = [
        { motion: this.motions[this.chosen], curve: 'd', k: 0, label: 'deviation', stroke: AXIS_COLOURS[1], width: 1 },
        { motion: this.motions[this.chosen], curve: 't', k: 0, label: 'tolerance', stroke: '#8a93a0', dash: [4, 3], width: 1 },
      ];
    } else {
      curves = inUse.map(k => ({ motion: this.motions[this.chosen], curve: kind.curve, k, label: this.meta.axes[k].name, stroke: AXIS_COLOURS[k % AXIS_COLOURS.length], width: 1 }));
    }
    for (const curve of curves) series.push({ label: curve.label, stroke: curve.stroke, dash: curve.dash, width: curve.width, value, points: { show: false } });
    const shown = kind.limits ? [...new Set(inUse.map(k => kind.limits[k]))] : [];
    const most = Math.max(0, ...shown);
    const range = kind.limits
      ? () => [-1.1 * (most || 1), 1.1 * (most || 1)]
      : (u, low, high) => [0, 1.1 * Math.max(high || 0, 1e-3)];
    const options = {
      width: this.width(), height: kind.height, title: kind.title, series,
      cursor: { y: false, drag: { x: true, y: false, setScale: false }, sync: { key: 'time', setSeries: false, filters: { pub: type => type === 'mousemove' || type === 'mouseleave' } } },
      scales: { x: { time: false, range: () => this.range }, y: { range } },
      axes: [{ ...ink, size: 26 }, { ...ink, size: 60 }],
      hooks: {
        setSelect: [u => {
          if (u.select.width < 4) return;
          const from = u.posToVal(u.select.left, 'x'), to = u.posToVal(u.select.left + u.select.width, 'x');
          u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
          this.zoom(from, to);
        }],
        draw: [u => {
          const c = u.ctx;
          c.save();
          c.setLineDash([6, 4]);
          c.lineWidth = 1;
          c.strokeStyle = '#c8352b';
          for (const limit of shown) {
            for (const side of [1, -1]) {
              const y = u.valToPos(side * limit, 'y', true);
              c.beginPath();
              c.moveTo(u.bbox.left, y);
              c.lineTo(u.bbox.left + u.bbox.width, y);
              c.stroke();
            }
          }
          c.restore();
        }],
      },
    };
    const plot = new uPlot(options, [[0], ...curves.map(() => [null])], this.element);
    plot.curves = curves;
    plot.root.setAttribute('role', 'img');
    plot.root.setAttribute('aria-label', `${kind.title} over time; the table and the clock hold the same numbers`);
    plot.over.addEventListener('click', event => {
      const box = plot.over.getBoundingClientRect();
      this.pick(plot.posToVal(event.clientX - box.left, 'x'));
    });
    plot.over.addEventListener('dblclick', () => this.zoom(0, this.duration));
    plot.over.addEventListener('wheel', event => {
      event.preventDefault();
      const box = plot.over.getBoundingClientRect(), at = plot.posToVal(event.clientX - box.left, 'x');
      const factor = Math.exp(event.deltaY * 0.0015);
      this.zoom(at - (at - this.range[0]) * factor, at + (this.range[1] - at) * factor);
    }, { passive: false });
    return plot;
  }
  zoom(from, to) {
    const least = 1e-6;
    from = Math.max(0, from);
    to = Math.min(this.duration, to);
    if (to - from < least) to = Math.min(this.duration, from + least);
    this.range = [from, to];
    this.draw();
  }
  // Every curve at twice as many times as the chart has pixels: the least and the greatest of each column.
  draw() {
    const [from, to] = this.range;
    const columns = Math.max(2, Math.min(1400, Math.round(this.width() - 64)));
    const x = new Float64Array(2 * columns);
    const width = (to - from) / columns;
    for (let c = 0; c < columns; c++) {
      x[2 * c] = from + (c + 0.25) * width;
      x[2 * c + 1] = from + (c + 0.75) * width;
    }
    for (const plot of this.plots) {
      const data = [x];
      for (const curve of plot.curves) data.push(this.sampled(curve, from, width, columns));
      plot.setData(data, false);
      plot.redraw(true, true);
      plot.setScale('x', { min: from, max: to });
    }
    this.mark(this.time ?? 0);
  }
  sampled({ motion, curve, k }, from, width, columns) {
    const y = new Array(2 * columns), { programmed } = motion;
    const factor = curve === 'd' || curve === 't' ? 1000 : 1;
    for (let c = 0; c < columns; c++) {
      const begin = from + c * width, end = begin + width;
      if (motion.n === 0 || begin > motion.duration) { y[2 * c] = y[2 * c + 1] = null; continue; }
      if (curve === 'f' || curve === 't') {
        const move = motion.move[motion.find(begin + width / 2)];
        const value = (curve === 'f' ? programmed.feedrate : programmed.tolerance)[move];
        y[2 * c] = y[2 * c + 1] = value > 0 ? factor * value : null;
        continue;
      }
      const [low, high] = motion.extremes(curve, k, begin, end);
      y[2 * c] = factor * low;
      y[2 * c + 1] = factor * high;
    }
    return y;
  }
  // Puts the cursor of every chart at a time.
  mark(time) {
    this.time = time;
    const inside = time >= this.range[0] && time <= this.range[1];
    for (const plot of this.plots) {
      plot.setCursor({ left: inside ? plot.valToPos(time, 'x') : -10, top: 4 }, false);
    }
  }
  choose(index) { this.chosen = index; this.build(); }
  resize() { this.build(); }
}
