// Tells which lines take longer than their feedrate asks, and why.
'use strict';

const CAUSES = ['standing still', 'an axis at its velocity', 'speeding up and slowing down', 'turning'];
const ROWS = 12;

function showLosses(motion, listing, pick) {
  const { line, first, time, ideal, lost } = motion.spent;
  const rows = [];
  const sums = CAUSES.map(() => 0);
  let whole = 0;
  for (let i = 0; i < line.length; i++) {
    const all = lost.map(cause => cause[i]), sum = all.reduce((a, b) => a + b, 0);
    whole += time[i];
    all.forEach((x, c) => { sums[c] += x; });
    if (sum > 5e-4) rows.push({ i, sum, cause: all.indexOf(Math.max(...all)) });
  }
  rows.sort((a, b) => b.sum - a.sum);
  const body = document.querySelector('#losses tbody');
  body.textContent = '';
  for (const { i, sum, cause } of rows.slice(0, ROWS)) {
    const row = document.createElement('tr');
    const head = document.createElement('td'), button = document.createElement('button');
    button.type = 'button';
    button.textContent = `${line[i]}  ${(listing.lines[line[i] - 1] ?? '').trim()}`;
    button.addEventListener('click', () => pick(first[i]));
    head.append(button);
    row.append(head);
    for (const text of [seconds(time[i]), seconds(ideal[i]), seconds(sum), CAUSES[cause]]) {
      const cell = document.createElement('td');
      cell.textContent = text;
      row.append(cell);
    }
    body.append(row);
  }
  document.getElementById('losses').hidden = rows.length === 0;
  const total = sums.reduce((a, b) => a + b, 0);
  const parts = sums.map((x, c) => [x, CAUSES[c]]).filter(([x]) => x > 5e-4).sort((a, b) => b[0] - a[0]);
  document.getElementById('causes').textContent = total > 5e-4
    ? `${seconds(total)} of ${seconds(whole)} are lost below the programmed feedrate: ${parts.map(([x, cause]) => `${seconds(x)} ${cause}`).join(', ')}.`
    : 'The motion keeps the programmed feedrate throughout.';
}

function seconds(value) { return value.toFixed(3) + ' s'; }
