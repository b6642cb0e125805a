// Joins the parts of the page: one time, one method, one cursor.
'use strict';

const byId = id => document.getElementById(id);

function clockText(seconds) {
  const minutes = Math.floor(seconds / 60);
  return minutes > 0 ? `${minutes} min ${(seconds - 60 * minutes).toFixed(3)} s` : `${seconds.toFixed(3)} s`;
}

async function start() {
  const begun = performance.now();
  const { meta, columns } = await unpack();
  const programmed = new Programmed(columns, meta.axes);
  const motions = motionsOf(meta, columns, programmed);
  const unpacked = performance.now();
  byId('title').textContent = meta.title;
  let time = 0, chosen = 0;
  const pick = asked => setTime(asked);
  const listing = new Listing(byId('program'), meta.program, pick);
  const view = new View(byId('path'), motions, programmed, meta.axes, pick);
  const meshed = performance.now();
  const charts = new Charts(byId('charts'), meta, motions, pick);

  function setTime(asked) {
    const motion = motions[chosen];
    time = Math.min(Math.max(asked, 0), motion.duration);
    const state = motion.state(time), line = programmed.line[state.move] ?? 0;
    const places = meta.axes.map((axis, k) => `${axis.name} ${state.p[k].toFixed(4)}`).join('  ');
    byId('now').textContent = `${time.toFixed(4)} s  line ${line}  ${places}  ${state.speed.toFixed(2)} mm/s`;
    byId('clock').value = motion.duration > 0 ? Math.round(1e5 * time / motion.duration) : 0;
    listing.mark(line);
    charts.mark(time);
    view.time = time;
    view.redraw();
  }
  function choose(index) {
    chosen = index;
    const motion = motions[index], { facts } = motion;
    byId('cycle').textContent = `${facts.name} on ${meta.machine} · ${clockText(facts.cycle_time)}`;
    byId('deviation').textContent = `deviation at most ${(1000 * facts.deviation_mm).toFixed(2)} µm, ${(100 * facts.deviation_share).toFixed(0)} % of the tolerance`;
    byId('verdict').textContent = facts.verdict;
    byId('verdict').className = facts.passes ? 'ok' : 'bad';
    byId('note').textContent = facts.envelope_width
      ? `${facts.pieces.toLocaleString('en')} pieces are too many for a page: least and greatest values of ${facts.envelope_width.toPrecision(3)} s are shown`
      : `${facts.pieces.toLocaleString('en')} pieces`;
    listing.show(motion);
    showLosses(motion, listing, pick);
    view.choose(index);
    charts.choose(index);
    setTime(time);
  }
  function colour() {
    const units = ['mm/s', 'mm/s²', 'mm/s³', 'µm'], kind = Number(byId('colour').value);
    view.colour = kind;
    byId('scale').style.visibility = kind === 4 ? 'hidden' : 'visible';
    const top = view.largest[kind] * (kind === 3 ? 1000 : 1);
    byId('high').textContent = kind === 4 ? '' : `${Number((top || 0).toPrecision(4))} ${units[kind]}`;
    view.redraw();
  }

  const bar = byId('bar').getContext('2d');
  for (let y = 0; y < 128; y++) {
    bar.fillStyle = `rgb(${rampAt(1 - y / 127)})`;
    bar.fillRect(0, y, 1, 1);
  }
  meta.motions.forEach((facts, index) => byId('method').add(new Option(`${facts.name}, ${clockText(facts.cycle_time)}`, index)));
  byId('pick').hidden = motions.length < 2;
  if (motions.length < 2) byId('colour').lastElementChild.remove();
  byId('method').addEventListener('change', event => choose(Number(event.target.value)));
  byId('colour').addEventListener('change', colour);
  byId('top').addEventListener('click', () => view.show(false));
  byId('side').addEventListener('click', () => view.show(true));
  byId('fit').addEventListener('click', () => view.fit());
  byId('clock').addEventListener('input', event => setTime(motions[chosen].duration * event.target.value / 1e5));
  let resizing;
  addEventListener('resize', () => {
    view.resize();
    clearTimeout(resizing);
    resizing = setTimeout(() => charts.resize(), 80);
  });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { charts.build(); view.redraw(); });
  const flat = view.bounds.high[2] - view.bounds.low[2] < 1e-9;
  choose(0);
  view.show(!flat && view.bounds.high[2] - view.bounds.low[2] > 0.2 * (view.bounds.high[0] - view.bounds.low[0]));
  colour();
  const asked = new URLSearchParams(location.hash.slice(1));
  if (asked.has('colour')) { byId('colour').value = asked.get('colour'); colour(); }
  if (asked.has('t')) setTime(Number(asked.get('t')));
  // For scripts that drive the page.
  window.toolglide = { meta, motions, view, charts, setTime, choose, state: () => ({ time, ...motions[chosen].state(time) }) };
  const done = performance.now();
  document.body.dataset.ms = JSON.stringify({ unpack: unpacked - begun, mesh: meshed - unpacked, charts: done - meshed });
  document.body.dataset.ready = 'yes';
}

start().catch(error => {
  byId('verdict').textContent = 'This page could not be shown: ' + error.message;
  byId('verdict').className = 'bad';
  throw error;
});
