"use strict";
// Floor plans of registered scans, of those that have no place, and where these may be.
const data = JSON.parse(document.getElementById("data").textContent);
const main = document.querySelector("main");
const PLACED = "#667", MOVED = "#c2410c", STATION = "#1d4ed8";
const identity = [1, 0, 0, 1, 0, 0];

function add(parent, name, text, attributes) {
  const element = document.createElement(name);
  if (text !== undefined) element.textContent = text;
  for (const [key, value] of Object.entries(attributes || {})) element.setAttribute(key, value);
  parent.append(element);
  return element;
}

function addSvg(parent, name, attributes, text) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  parent.append(element);
  return element;
}

const moved = ([a, b, c, d, e, f], [x, y]) => [a * x + c * y + e, b * x + d * y + f];

function pointsOf(scan, motion) {
  const points = [];
  for (let k = 0; k + 1 < scan.outline.length; k += 2)
    points.push(moved(motion, [scan.outline[k] * data.voxel, scan.outline[k + 1] * data.voxel]));
  return points;
}

// Of what most points lie in: rays through windows reach far.
function boxOf(points) {
  const box = [];
  for (const axis of [0, 1]) {
    const sorted = points.map(p => p[axis]).sort((x, y) => x - y);
    const at = share => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] || 0;
    box.push([at(0.003), at(0.997)]);
  }
  return box;
}

// Corners of the smallest convex region (Andrew 1979).
function hull(points) {
  const sorted = [...points].sort((p, q) => p[0] - q[0] || p[1] - q[1]);
  const left = (o, p, q) => (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]) > 0;
  const chain = list => {
    const corners = [];
    for (const point of list) {
      while (corners.length > 1 && !left(corners[corners.length - 2], corners[corners.length - 1], point)) corners.pop();
      corners.push(point);
    }
    return corners.slice(0, -1);
  };
  return chain(sorted).concat(chain(sorted.reverse()));
}

// A plan: y goes up. layers: {scans, motion, color, region, names}; box is what it shows.
function drawPlan(parent, layers, box, className) {
  const [[x0, x1], [y0, y1]] = box, margin = 0.08 * Math.max(x1 - x0, y1 - y0, 1);
  const width = x1 - x0 + 2 * margin, height = Math.max(y1 - y0 + 2 * margin, 0.4 * width);
  const top = -(y0 + y1) / 2 - height / 2;
  const svg = addSvg(parent, "svg", {viewBox: `${x0 - margin} ${top} ${width} ${height}`, class: className || "",
                                     role: "img"});
  const unit = width / Math.max(200, svg.clientWidth || 320); // a pixel
  const dot = Math.max(1.1 * data.voxel, 1.2 * unit);
  for (const layer of layers) {
    const group = addSvg(svg, "g", {transform: "scale(1,-1)"});
    const points = layer.scans.map(scan => pointsOf(scan, layer.motion));
    if (layer.region) {
      const [bx, by] = boxOf(points.flat());
      const inside = points.flat().filter(p => p[0] >= bx[0] && p[0] <= bx[1] && p[1] >= by[0] && p[1] <= by[1]);
      addSvg(group, "polygon", {points: hull(inside).map(p => p.join(",")).join(" "), fill: layer.color,
                                "fill-opacity": 0.12, stroke: layer.color, "stroke-width": 2 * unit});
    }
    addSvg(group, "path", {d: points.flat().map(p => `M${p[0].toFixed(2)} ${p[1].toFixed(2)}h0`).join(""),
                           stroke: layer.color, "stroke-width": dot, "stroke-linecap": "round", fill: "none"});
  }
  for (const layer of layers)
    for (const scan of layer.scans) {
      const [x, y] = moved(layer.motion, scan.station);
      addSvg(svg, "circle", {cx: x, cy: -y, r: 5 * unit, fill: layer.stations || layer.color, stroke: "#fff",
                             "stroke-width": unit});
      addSvg(svg, "text", {x: x + 7 * unit, y: -y + 4 * unit, "font-size": 12 * unit, fill: "#111", stroke: "#fff",
                           "stroke-width": 3 * unit, "paint-order": "stroke"}, shortName(scan));
    }
  drawScale(svg, x0 - margin, top + height, width, unit);
}

function drawScale(svg, left, bottom, width, unit) {
  const length = [100, 50, 20, 10, 5, 2, 1, 0.5, 0.2, 0.1].find(l => l < width / 4) || width / 4;
  const x = left + 10 * unit, y = bottom - 10 * unit;
  addSvg(svg, "path", {d: `M${x} ${y}h${length}`, stroke: "#111", "stroke-width": 2 * unit});
  addSvg(svg, "text", {x: x + length + 5 * unit, y: y + 4 * unit, "font-size": 12 * unit}, String(length));
}

// What all names have in common says nothing.
function shortName(scan) { return scan.name.replace(/\.[a-z0-9]+$/i, "").replace(/^scan_0*(?=\d)/, ""); }

// Messages call scans by their whole paths.
function withoutFolders(text) {
  return data.scans.reduce((words, scan) => words.replaceAll(scan.file, scan.name), text);
}

const usable = data.scans.filter(scan => scan.group >= 0 && scan.outline);
const inGroup = group => usable.filter(scan => scan.group === group);
const placed = inGroup(0).filter(scan => scan.placed);
const number = (value, digits) => value.toFixed(digits);
const pointsOfAll = (scans, motion) => scans.flatMap(scan => pointsOf(scan, motion));

// As bets have it, too.
function odds(p) {
  if (p < 0.01) return "below 0.01";
  return `${number(p, p > 0.9 ? 3 : 2)} (${p < 0.5 ? `1:${number(1 / p - 1, 0)}` : `${number(p / (1 - p), 0)}:1`})`;
}

function takeLine(parent, line) {
  const take = add(parent, "div", undefined, {class: "take"});
  const code = add(take, "code", line);
  const button = add(take, "button", "copy", {type: "button"});
  button.onclick = () => {
    const range = document.createRange(); // also where the page is a local file
    range.selectNodeContents(code);
    getSelection().removeAllRanges();
    getSelection().addRange(range);
    button.textContent = document.execCommand("copy") ? "copied" : "marked";
  };
}

function drawCandidate(parent, candidate, members, place) {
  const card = add(parent, "div", undefined, {class: "card"});
  const beside = data.scans[candidate.beside], others = beside.group === 0 ? placed : inGroup(beside.group);
  add(card, "h3", `Place ${place}: beside ${shortName(beside)}` + (beside.placed ? "" : ", which has no place itself"));
  const around = boxOf(pointsOfAll(members, candidate.motion).concat(pointsOfAll([beside], identity)));
  drawPlan(card, [{scans: others, motion: identity, color: PLACED, stations: STATION},
                  {scans: members, motion: candidate.motion, color: MOVED, region: true}], around);
  const table = add(card, "table");
  const row = (name, value, bad) => {
    const line = add(table, "tr");
    add(line, "td", name);
    add(line, "td", value, bad ? {class: "bad"} : {});
  };
  row("probability", odds(candidate.probability));
  row("surfaces that agree", `those of ${number(candidate.agree, 2)} scans`);
  row("contradicted", candidate.contradicted
    ? `yes: ${number(100 * candidate.contradict, 1)} % of a scan lies where others saw through`
    : `no (${number(100 * candidate.contradict, 2)} % of a scan)`, candidate.contradicted);
  row(`overlap of ${shortName(data.scans[candidate.scan])} and ${shortName(beside)}`,
      `${number(100 * candidate.overlap, 0)} %` + (candidate.number > 0 ? "" : ", found by floor plans"));
  add(card, "div", "To take this place, the line for the hints file:");
  takeLine(card, candidate.hint);
}

function drawGroup(group) {
  const members = inGroup(group);
  if (members.length === 0) return;
  const section = add(main, "section");
  const names = members.map(scan => scan.name).join(", ");
  add(section, "h2", members.length > 1 ? `A group of ${members.length} scans that is not joined: ${names}`
                                        : `Not placed: ${names}`);
  add(section, "p", `Why: ${withoutFolders(members[0].problem)}.`);
  const cards = add(section, "div", undefined, {class: "cards"});
  const own = add(cards, "div", undefined, {class: "card"});
  add(own, "h3", members.length > 1 ? "The group by itself" : "The scan by itself");
  drawPlan(own, [{scans: members, motion: identity, color: MOVED}], boxOf(pointsOfAll(members, identity)));
  const candidates = data.candidates.filter(candidate => candidate.group === group);
  candidates.forEach((candidate, k) => drawCandidate(cards, candidate, members, k + 1));
  if (candidates.length === 0)
    add(own, "p", "No place was found. A scan between it and the placed ones helps, or a line \"relative\" with a rough "
                  + "pose.");
}

function drawIntroduction() {
  const others = usable.length - placed.length;
  add(main, "h1", `${placed.length} of ${data.scans.length} scans are placed`);
  add(main, "p", "Floor plans, seen from above. Points are walls and furniture, dots are the places of the scanner.");
  if (others > 0)
    add(main, "p", "Below, each scan or group without a place is shown with the best places that were found, the best "
                   + "first. Places that look alike cannot be told apart by the data: look, choose one, put its line into "
                   + "a file hints.txt, and run the same command again with -hints hints.txt -resume. That takes seconds.");
  const key = add(main, "p", undefined, {class: "key"});
  for (const [color, text] of [[PLACED, "surfaces of placed scans"], [STATION, "their scanners"],
                               [MOVED, "what has no place"]]) {
    add(key, "i", undefined, {style: `background:${color}`});
    key.append(text);
  }
  for (const line of data.hints) add(main, "p", "Hint: " + withoutFolders(line));
}

function drawAll() {
  main.replaceChildren();
  drawIntroduction();
  const section = add(main, "section");
  add(section, "h2", "The placed scans");
  if (placed.length > 0)
    drawPlan(section, [{scans: placed, motion: identity, color: PLACED, stations: STATION}],
             boxOf(pointsOfAll(placed, identity)), "wide");
  const sure = [...placed].sort((a, b) => a.probability - b.probability);
  add(section, "p", "Probability of each place, the least sure first: "
                    + sure.map(scan => `${shortName(scan)} ${odds(scan.probability)}`).join(", "));
  const hinted = placed.filter(scan => scan.hint);
  if (hinted.length > 0)
    add(section, "p", "Placed by hints: " + hinted.map(scan => `${shortName(scan)} (${scan.hint})`).join(", "));
  for (const scan of inGroup(0).filter(s => !s.placed)) add(section, "p", `Not placed: ${scan.name}: ${withoutFolders(scan.problem)}`);
  const groups = [...Array(data.groups).keys()].slice(1);
  groups.forEach(drawGroup);
  const unusable = data.scans.filter(scan => !(scan.group >= 0 && scan.outline));
  if (unusable.length > 0) {
    const list = add(main, "section");
    add(list, "h2", "Left out");
    for (const scan of unusable) add(list, "p", `${scan.name}: ${withoutFolders(scan.problem)}`);
  }
}

drawAll();
let width = innerWidth;
addEventListener("resize", () => { if (width !== innerWidth) { width = innerWidth; drawAll(); } });
