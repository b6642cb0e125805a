// Lists the program, with the time of each line; only lines in view exist.
'use strict';

const LINE = 18; // pixels
const TALLEST = 3e7; // pixels that browsers scroll over

class Listing {
  constructor(element, text, pick) {
    this.element = element;
    this.inner = element.firstElementChild;
    this.lines = text.length ? text.split(/\r\n|\n|\r/) : [];
    this.pick = pick;
    this.hit = 0;
    this.inner.style.height = Math.min(TALLEST, Math.max(1, this.lines.length * LINE)) + 'px';
    if (!this.lines.length) this.inner.textContent = 'The text of the program is not at hand.';
    element.addEventListener('scroll', () => this.draw());
    this.inner.addEventListener('click', event => {
      const row = event.target.closest('.l');
      if (row) this.choose(Number(row.dataset.line));
    });
    element.addEventListener('keydown', event => {
      const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (!step) return;
      event.preventDefault();
      for (let line = this.hit + step; line >= 1 && line <= this.lines.length; line += step) {
        if (this.first.has(line)) { this.choose(line); return; }
      }
    });
  }
  show(motion) {
    const { line, time, first } = motion.spent;
    this.time = new Map();
    this.first = new Map();
    for (let i = 0; i < line.length; i++) {
      this.time.set(line[i], time[i]);
      this.first.set(line[i], first[i]);
    }
    this.draw();
  }
  choose(line) {
    const time = this.first.get(line);
    if (time !== undefined) this.pick(time);
  }
  // The line at the top of the list.
  topLine() {
    const { scrollTop, clientHeight } = this.element, count = this.lines.length;
    if (count * LINE <= TALLEST) return Math.floor(scrollTop / LINE);
    const share = scrollTop / Math.max(1, TALLEST - clientHeight);
    return Math.floor(share * Math.max(0, count - clientHeight / LINE));
  }
  mark(line) {
    if (line === this.hit) return;
    this.hit = line;
    const rows = Math.floor(this.element.clientHeight / LINE), top = this.topLine(), count = this.lines.length;
    if (line - 1 < top || line - 1 > top + rows - 2) {
      const wanted = Math.max(0, line - 1 - Math.floor(rows / 2));
      this.element.scrollTop = count * LINE <= TALLEST
        ? wanted * LINE
        : wanted / Math.max(1, count - rows) * (TALLEST - this.element.clientHeight);
    }
    this.draw();
  }
  draw() {
    if (!this.lines.length || !this.time) return;
    const top = this.topLine(), rows = Math.ceil(this.element.clientHeight / LINE) + 2;
    const short = this.lines.length * LINE <= TALLEST, base = this.element.scrollTop;
    this.inner.textContent = '';
    for (let i = Math.max(0, top); i < Math.min(this.lines.length, top + rows); i++) {
      const row = document.createElement('div');
      row.className = i + 1 === this.hit ? 'l hit' : 'l';
      row.dataset.line = i + 1;
      row.setAttribute('role', 'option');
      row.setAttribute('aria-selected', String(i + 1 === this.hit));
      row.style.top = (short ? i * LINE : base + (i - top) * LINE) + 'px';
      const number = document.createElement('i'), time = document.createElement('i');
      number.className = 'n';
      number.textContent = i + 1;
      time.className = 's';
      const spent = this.time.get(i + 1);
      time.textContent = spent ? spent.toFixed(3) + ' s' : '';
      row.append(number, time, this.lines[i]);
      this.inner.append(row);
    }
  }
}
