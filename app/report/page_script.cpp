#include "ridgeline/app/report/page_assets.h"

namespace ridgeline::app::report {

// Values are read back from the paths of the curves (curve_path.h): steps of whole units from the upper left.
const std::string_view kPageScript = R"js(
(() => {
'use strict';
const walk = document.querySelector('main').dataset;
const columns = +walk.columns;
const make = (name, style, parent) => {
  const element = document.createElement(name);
  element.className = style;
  return parent.appendChild(element);
};
const group = text => text.replace(/\B(?=(\d{3})+$)/g, '\u202f');
const three = v => Math.abs(v) >= 100 ? group(String(+v.toPrecision(3))) : String(+v.toPrecision(3));
const bytes = v => {
  let unit = 0;
  for (; v >= 1024 && unit < 4; ++unit) v /= 1024;
  return three(v) + '\u202f' + ['B', 'KiB', 'MiB', 'GiB', 'TiB'][unit];
};
const text = (v, unit) => unit === 'B' ? bytes(Math.max(0, v)) : unit === '' ? three(Math.round(v)) : three(v) + '\u202f' + unit;

const points = path => {
  const steps = path.getAttribute('d').match(/-?\d+/g).map(Number);
  const list = [];
  for (let i = 0, x = 0, y = 0; i < steps.length; i += 2) list.push([x += steps[i], y += steps[i + 1]]);
  return list;
};
const readCurve = (plot, g) => {
  const line = points(g.querySelector('.line'));
  const band = g.querySelector('.band') && points(g.querySelector('.band'));
  const value = y => plot.y1 - y / plot.height * (plot.y1 - plot.y0);
  return {
    style: g.getAttribute('class').split(' ')[1], letter: g.dataset.run, x: line.map(p => p[0]),
    middle: line.map(p => value(p[1])),
    most: band && line.map((_, i) => value(band[i][1])),
    least: band && line.map((_, i) => value(band[band.length - 1 - i][1])),
  };
};
const nearest = (list, x) => {
  let low = 0, high = list.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (list[middle] <= x) low = middle; else high = middle;
  }
  return x - list[low] <= list[high] - x ? low : high;
};

const plots = [...document.querySelectorAll('.plot.curve')].map(element => {
  const area = element.querySelector('.area');
  const svg = area.querySelector('svg');
  const plot = { element, area, svg, unit: element.dataset.unit, y0: +element.dataset.y0, y1: +element.dataset.y1,
                 height: svg.viewBox.baseVal.height, readout: element.parentElement.querySelector('.readout') };
  plot.cross = make('i', 'cross', area);
  plot.cross.hidden = true;
  plot.dots = [];
  return plot;
});
const curvesOf = plot => plot.curves ??= [...plot.svg.querySelectorAll('.run')].map(g => readCurve(plot, g)).reverse();
const visible = curve => !document.body.classList.contains('hide-' + curve.style.slice(1));
const several = document.body.classList.contains('several');
const shots = [...document.querySelectorAll('.shots figure')];
const tip = make('div', 'tip', document.body);
tip.hidden = true;
tip.setAttribute('role', 'status');

const hide = () => {
  for (const plot of plots) {
    plot.cross.hidden = true;
    plot.readout.textContent = '';
    for (const dot of plot.dots) dot.hidden = true;
  }
  for (const shot of shots) shot.classList.remove('near');
  tip.hidden = true;
};
const markPlot = (plot, share) => {
  plot.cross.hidden = false;
  plot.cross.style.left = 100 * share + '%';
  plot.readout.textContent = '';
  curvesOf(plot).forEach((curve, i) => {
    const dot = plot.dots[i] ??= make('i', 'dot run ' + curve.style, plot.area);
    const at = nearest(curve.x, share * columns - .5);
    const up = (curve.middle[at] - plot.y0) / (plot.y1 - plot.y0);
    dot.hidden = !(up >= 0 && up <= 1);
    dot.style.left = 100 * (curve.x[at] / columns) + '%';
    dot.style.bottom = 100 * up + '%';
    if (!visible(curve)) return;
    const word = make('b', curve.style, plot.readout);
    word.textContent = (several ? curve.letter + '\u2002' : '') + text(curve.middle[at], plot.unit);
  });
};
const fillTip = (plot, share) => {
  tip.textContent = '';
  const when = +walk.first + share * (walk.last - walk.first);
  make('div', '', tip).textContent = walk.unit === 's' ? when.toFixed(2) + '\u202fs' : 'frame ' + Math.round(when);
  const table = make('table', '', tip);
  for (const curve of curvesOf(plot).filter(visible)) {
    const at = nearest(curve.x, share * columns - .5);
    const row = make('tr', curve.style, table);
    if (several) make('th', '', row).textContent = curve.letter;
    make('td', '', row).textContent = text(curve.middle[at], plot.unit);
    if (curve.most && curve.most[at] - curve.least[at] > 0)
      make('small', '', make('td', '', row)).textContent =
        text(curve.least[at], plot.unit) + ' to ' + text(curve.most[at], plot.unit);
  }
};
const markShots = share => {
  for (const strip of document.querySelectorAll('.shots')) {
    let best = null, least = 2;
    for (const shot of strip.children) {
      shot.classList.remove('near');
      const apart = Math.abs(parseFloat(shot.dataset.at) / 100 - share);
      if (apart < least) { least = apart; best = shot; }
    }
    if (best) best.classList.add('near');
  }
};
let place = .5;
const show = (plot, share, x, y) => {
  place = Math.min(1, Math.max(0, share));
  for (const each of plots) markPlot(each, place);
  markShots(place);
  fillTip(plot, place);
  tip.hidden = false;
  const box = tip.getBoundingClientRect();
  tip.style.left = (x + 18 + box.width < innerWidth ? x + 18 : Math.max(4, x - 18 - box.width)) + 'px';
  tip.style.top = Math.max(4, Math.min(y - box.height - 12, innerHeight - box.height - 4)) + 'px';
};
for (const plot of plots) {
  const { area, element } = plot;
  area.addEventListener('pointermove', event => {
    const box = area.getBoundingClientRect();
    show(plot, (event.clientX - box.left) / box.width, event.clientX, event.clientY);
  });
  area.addEventListener('pointerleave', hide);
  element.tabIndex = 0;
  element.addEventListener('blur', hide);
  element.addEventListener('keydown', event => {
    const step = { ArrowLeft: -.005, ArrowRight: .005, PageUp: -.1, PageDown: .1 }[event.key];
    if (event.key === 'Escape') hide();
    if (step === undefined) return;
    event.preventDefault();
    const box = area.getBoundingClientRect();
    const next = Math.min(1, Math.max(0, place + step));
    show(plot, next, box.left + next * box.width, box.top + 40);
  });
}

document.querySelectorAll('.keys .key').forEach((key, run) => {
  key.setAttribute('role', 'button');
  key.setAttribute('aria-pressed', 'true');
  key.tabIndex = 0;
  const toggle = () => key.setAttribute('aria-pressed', String(!document.body.classList.toggle('hide-' + run)));
  key.addEventListener('click', toggle);
  key.addEventListener('keydown', event => {
    if (event.key !== 'Enter' && event.key !== ' ') return;
    event.preventDefault();
    toggle();
  });
});
})();
)js";

}  // namespace ridgeline::app::report
