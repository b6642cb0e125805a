// Opens pages of toolglide in Chromium and checks what they show against the set-points of the same plan.
//
// Usage: node check.mjs TOOLGLIDE PROGRAM... ; TOOLGLIDE is the command, CHROMIUM the browser (/usr/bin/chromium).
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { chromium } from 'playwright-core';

const NEAR = 1e-6; // mm, between page and set-points
const BRACKET_BYTES = 200_000;
const KEEP = process.env.KEEP_PICTURES; // a folder for pictures to look at

const [command, ...programs] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), 'toolglide-report-'));
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--enable-unsafe-swiftshader', '--use-angle=swiftshader'],
});
let failures = 0;

function check(holds, text) {
  console.log(`${holds ? 'ok  ' : 'FAIL'} ${text}`);
  if (!holds) failures += 1;
}

// A page that is open and has drawn itself; what it asked for and complained of.
async function opened(file, hash = '') {
  const context = await browser.newContext({ viewport: { width: 1400, height: 900 } });
  const page = await context.newPage();
  const asked = [], complaints = [];
  page.on('request', request => { if (!request.url().startsWith('file:')) asked.push(request.url()); });
  page.on('console', message => { if (message.type() === 'error') complaints.push(message.text()); });
  page.on('pageerror', error => complaints.push(String(error)));
  await page.goto(`file://${file}${hash}`);
  await page.waitForSelector('body[data-ready=yes]', { timeout: 120_000 });
  return { page, asked, complaints, context };
}

function planned(program, ...more) {
  const file = join(folder, basename(program) + '.html'), rows = join(folder, 'rows.csv');
  execFileSync(command, ['plan', program, '--report', file, '-o', rows, '--json', ...more], { stdio: ['ignore', 'ignore', 'inherit'] });
  const lines = readFileSync(rows, 'utf8').trim().split('\n');
  const header = lines[0].split(',');
  return { file, header, rows: lines.slice(1).map(line => line.split(',').map(Number)) };
}

for (const program of programs) {
  const name = basename(program), { file, rows } = planned(program);
  const { page, asked, complaints, context } = await opened(file);
  const every = Math.max(1, Math.floor(rows.length / 400));
  const times = rows.filter((_, i) => i % every === 0);
  const worst = await page.evaluate(rows => {
    let worst = 0;
    for (const [time, ...places] of rows) {
      toolglide.setTime(time);
      const { p } = toolglide.state();
      places.forEach((place, k) => { worst = Math.max(worst, Math.abs(place - p[k])); });
    }
    return worst;
  }, times);
  check(worst <= NEAR, `${name}: ${times.length} set-points are met within ${worst.toExponential(1)} mm`);
  const facts = await page.evaluate(() => ({ ...toolglide.meta.motions[0], duration: toolglide.motions[0].duration }));
  const last = rows.at(-1)[0];
  check(Math.abs(facts.duration - last) <= 1e-9, `${name}: lasts ${facts.duration} s, the last row is at ${last} s`);
  check(facts.passes && (await page.textContent('#verdict')).includes('kept'), `${name}: the verdict is shown`);

  // A drag over a chart zooms all of them; two clicks show all again.
  const box = await page.locator('.u-over').first().boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 20);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 30, { steps: 4 });
  await page.mouse.up();
  const range = await page.evaluate(() => toolglide.charts.range);
  check(Math.abs(range[0] - 0.3 * last) < 0.02 * last && Math.abs(range[1] - 0.5 * last) < 0.02 * last, `${name}: a drag zooms to ${range.map(x => x.toFixed(2))} s`);
  if (KEEP) await page.screenshot({ path: join(KEEP, name + '-zoom.png') });
  await page.locator('.u-over').first().dblclick();
  check(Math.abs((await page.evaluate(() => toolglide.charts.range))[1] - last) < 1e-8, `${name}: a double click shows all`);

  // A click on a line of the program sets the time at which the motion comes to it.
  await page.evaluate(() => { document.getElementById('program').scrollTop = 0; });
  await page.waitForTimeout(100); // the list draws itself again when it has scrolled
  const line = await page.evaluate(() => [...document.querySelectorAll('.l')].find(row => row.querySelector('.s').textContent)?.dataset.line);
  if (line) {
    const row = await page.locator(`.l[data-line="${line}"]`).boundingBox();
    await page.mouse.click(row.x + 200, row.y + 9);
    const hit = await page.evaluate(() => ({ line: toolglide.state().move, now: document.getElementById('now').textContent }));
    check(hit.now.includes(`line ${line} `), `${name}: a click on line ${line} goes there`);
  }
  // A click on the path sets the time, too; the keyboard moves it.
  await page.evaluate(() => toolglide.setTime(0));
  const at = await page.evaluate(() => {
    const { view } = toolglide, state = toolglide.motions[0].state(0.5 * toolglide.motions[0].duration);
    const [x, y] = view.camera.project([0, 1, 2].map(k => state.p[k] ?? 0)), box = view.element.getBoundingClientRect();
    return [box.left + x, box.top + y];
  });
  await page.mouse.click(...at);
  check(await page.evaluate(() => toolglide.state().time > 0), `${name}: a click on the path sets the time`);
  await page.focus('#clock');
  const before = await page.evaluate(() => toolglide.state().time);
  await page.keyboard.press('PageUp');
  check(await page.evaluate(() => toolglide.state().time) !== before, `${name}: the clock obeys the keyboard`);
  await page.evaluate(() => toolglide.setTime(0.37 * toolglide.motions[0].duration));
  await page.waitForTimeout(300);
  if (KEEP) await page.screenshot({ path: join(KEEP, name + '.png') });
  if (KEEP) {
    await page.setViewportSize({ width: 600, height: 900 });
    await page.waitForTimeout(300);
    await page.screenshot({ path: join(KEEP, name + '-600.png'), fullPage: true });
  }
  const drawn = await page.evaluate(() => {
    const canvas = document.getElementById('path'), copy = document.createElement('canvas');
    copy.width = canvas.width; copy.height = canvas.height;
    const context = copy.getContext('2d');
    context.drawImage(canvas, 0, 0);
    const pixels = context.getImageData(0, 0, copy.width, copy.height).data, colours = new Set();
    for (let i = 0; i < pixels.length; i += 4) colours.add(pixels[i] << 16 | pixels[i + 1] << 8 | pixels[i + 2]);
    return colours.size;
  });
  check(drawn > 8, `${name}: the path shows ${drawn} colours`);
  check(asked.length === 0, `${name}: nothing is asked of a network${asked.length ? ': ' + asked : ''}`);
  check(complaints.length === 0, `${name}: no complaint${complaints.length ? ': ' + complaints : ''}`);
  console.log(`     ${name}: ${statSync(file).size} bytes, ${await page.evaluate(() => document.body.dataset.ms)} ms of script`);
  if (name === 'bracket.ngc') check(statSync(file).size <= BRACKET_BYTES, `${name}: ${statSync(file).size} bytes, ${BRACKET_BYTES} at the most`);
  await context.close();
}

// Awkward programs.
{
  const program = join(folder, 'awkward &lt; <b>.ngc');
  writeFileSync(program, '(</script><script>alert.1</script> & \u00e9)\nG21 G90 F600\nG1 X5 Y0\nX5 Y5\nM2\n');
  const { page, complaints, context } = await opened(planned(program).file);
  check((await page.textContent('#program')).includes('</script>'), 'a program may say </script>');
  check((await page.textContent('#title')).includes('<b>'), 'so may its name');
  check(complaints.length === 0, `no complaint${complaints.length ? ': ' + complaints : ''}`);
  await context.close();
}
{
  const program = join(folder, 'none.ngc');
  writeFileSync(program, 'G21 G90\nM2\n');
  const { page, complaints, context } = await opened(planned(program).file);
  check(complaints.length === 0, `a program without a move is shown${complaints.length ? ': ' + complaints : ''}`);
  check((await page.textContent('#cycle')).includes('0.000 s'), 'it takes no time');
  await context.close();
}
// Without WebGL2 the path is drawn on a plain canvas.
{
  const { page, complaints, context } = await opened(planned(programs[0]).file, '#plain');
  check(await page.evaluate(() => toolglide.view.drawn.constructor.name) === 'PlainCanvas', 'a plain canvas draws the path');
  if (KEEP) await page.screenshot({ path: join(KEEP, 'plain.png') });
  check(complaints.length === 0, `no complaint${complaints.length ? ': ' + complaints : ''}`);
  await context.close();
}
// Contrast of text, light and dark.
for (const scheme of ['light', 'dark']) {
  const { page, context } = await opened(planned(programs[0]).file);
  await page.emulateMedia({ colorScheme: scheme });
  const ratios = await page.evaluate(() => {
    const channel = x => (x /= 255, x <= 0.03928 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
    const luminance = text => {
      const [r, g, b] = text.match(/[\d.]+/g).map(Number);
      return 0.2126 * channel(r) + 0.7152 * channel(g) + 0.0722 * channel(b);
    };
    const probe = document.createElement('span');
    document.body.append(probe);
    const seen = name => { probe.style.color = `var(--${name})`; return luminance(getComputedStyle(probe).color); };
    const back = ['bg', 'card'].map(seen), out = {};
    for (const name of ['fg', 'dim', 'ok', 'bad', 'accent']) {
      out[name] = Math.min(...back.map(b => { const f = seen(name); return (Math.max(f, b) + 0.05) / (Math.min(f, b) + 0.05); }));
    }
    return out;
  });
  for (const [name, ratio] of Object.entries(ratios)) check(ratio >= 4.5, `${scheme}: contrast of ${name} is ${ratio.toFixed(1)}:1`);
  if (KEEP) await page.screenshot({ path: join(KEEP, `scheme-${scheme}.png`) });
  await context.close();
}
await browser.close();
rmSync(folder, { recursive: true });
if (failures) console.error(`${failures} checks failed`);
process.exit(failures ? 1 : 0);
