// The page: what is shown, what came over the socket, and the controls.
import * as THREE from 'three';
import 'uplot/dist/uPlot.min.css';
import './view.css';
import { address_of_state, kLayers, state_of_address } from './address.js';
import { Connection } from './connection.js';
import { Curves } from './curves.js';
import { draw_depth } from './depth.js';
import { Pane } from './pane.js';

const kKind = { blocks: 1, scan: 2, tried: 3, cad: 4 };
const at = (id) => document.getElementById(id);
const number = (value) => value.toLocaleString('en').replaceAll(',', ' ');

const state = state_of_address(location.hash);
const camera = new THREE.PerspectiveCamera(50, 1, 0.02, 500);
camera.up.set(0, 0, 1);
const target = new THREE.Vector3();
let placed = false; // the camera has been put somewhere
let facts = []; // by run
let panes = []; // in the order of state.runs
let playing = null;

// Drawing: only when something has changed, and once more in full when it has come to rest.

const kRest_ms = 200;
/// A renderer in software shares the processors with the run it shows: so often while views come in.
const kArrival_ms = 100;
let drawing = false;
let rest = null;
let arrival_timer = null;
let arrived_ms = -Infinity;

/// Something came over the socket, and more may follow at once.
function arrived() {
  arrived_ms = performance.now();
  if (arrival_timer) return;
  arrival_timer = setTimeout(() => {
    arrival_timer = null;
    redraw();
  }, panes.some((pane) => pane.software) ? kArrival_ms : 0);
}

function redraw() {
  if (drawing) return;
  drawing = true;
  requestAnimationFrame(() => {
    drawing = false;
    const moving = panes.some((pane) => pane.dragged) || playing !== null || performance.now() - arrived_ms < kRest_ms;
    for (const pane of panes) pane.render(moving);
    clearTimeout(rest);
    if (moving) rest = setTimeout(redraw_at_rest, kRest_ms);
  });
}
function redraw_at_rest() {
  for (const pane of panes) pane.render(false);
}

function write_address() {
  if (placed) state.camera = [...camera.position.toArray(), ...target.toArray()];
  const address = address_of_state(state);
  if (address !== location.hash) history.replaceState(null, '', address);
}
let address_timer = null;
function changed() {
  redraw();
  clearTimeout(address_timer);
  address_timer = setTimeout(write_address, 150);
}

// Runs and panes

const pane_of = (run) => panes.find((pane) => pane.run === run);
const last_view = () => Math.max(0, ...panes.map((pane) => pane.rows.length));

function make_panes() {
  for (const pane of panes) pane.dispose();
  panes = state.runs.map((run) => new Pane(run, camera, target, changed));
  at('panes').replaceChildren(...panes.map((pane) => pane.element));
  at('panes').classList.toggle('two', panes.length > 1);
  at('depths').classList.toggle('two', panes.length > 1);
  at('depths').replaceChildren(...panes.map((pane) => {
    pane.depth = document.createElement('canvas');
    pane.depth.setAttribute('role', 'img');
    pane.depth.setAttribute('aria-label', 'The range image as a picture of depth');
    pane.depth.className = 'depth';
    return pane.depth;
  }));
  for (const pane of panes) {
    pane.canvas.addEventListener('keydown', move_by_key);
    pane.canvas.addEventListener('wheel', brake, { passive: true });
    if (facts[pane.run]?.config) pane.set_config(facts[pane.run].config);
    pane.apply(state);
  }
}

/// A wheel's steps count as moving.
function brake() {
  for (const pane of panes) pane.dragged = true;
  clearTimeout(brake.timer);
  brake.timer = setTimeout(() => {
    for (const pane of panes) pane.dragged = false;
    changed();
  }, 150);
}

/// Another choice of runs: a socket starts with nothing sent.
function choose_runs(runs) {
  state.runs = runs;
  make_panes();
  connection.socket.close();
  changed();
}

function ask() {
  for (const pane of panes) connection.say({ show: pane.run, view: state.view });
  if (state.layers.cad > 0) ask_for_cad();
}

function ask_for_cad() {
  for (const pane of panes) {
    if (pane.cad_asked || !facts[pane.run]?.config) continue;
    pane.cad_asked = true;
    connection.say({ cad: pane.run });
  }
}

function choose_view(view) {
  state.view = view === null ? null : Math.min(Math.max(view, 0), last_view());
  for (const pane of panes) connection.say({ show: pane.run, view: state.view });
  show_transport();
  changed();
}

function play(on) {
  clearInterval(playing);
  playing = null;
  if (on) {
    if (state.view === null || state.view >= last_view()) choose_view(0);
    playing = setInterval(() => {
      if (state.view >= last_view()) {
        play(false);
      } else if (panes.every((pane) => pane.view === Math.min(state.view, pane.rows.length))) {
        choose_view(state.view + 1); // the one before has been seen
      }
    }, 1000 / state.speed);
  }
  at('play').textContent = on ? 'Stop' : 'Play';
  at('play').setAttribute('aria-pressed', String(on));
  redraw();
}

// The run itself

const pausable = () => panes.find((pane) => facts[pane.run]?.pausable);
function pace(last) {
  const pane = pausable();
  if (pane) connection.say({ pace: pane.run, last_view: last });
}
function pause() {
  const pane = pausable();
  if (pane) pace(facts[pane.run].paused_after === null ? pane.rows.length : null);
}
function step() {
  const pane = pausable();
  if (pane) pace(Math.max(facts[pane.run].paused_after ?? 0, pane.rows.length) + 1);
}

// What is said

function show_transport() {
  const last = last_view();
  const view = state.view ?? last;
  at('view').max = last;
  at('view').value = view;
  at('view-text').textContent = `${view} of ${last}`;
  at('follow').checked = state.view === null;
  const pane = pausable();
  at('pacing').hidden = !pane;
  if (pane) {
    const paused = facts[pane.run].paused_after !== null;
    at('pause').textContent = paused ? 'Let the run go on' : 'Pause the run';
    at('pause').setAttribute('aria-pressed', String(paused));
  }
}

function lines_of(pane) {
  const row = pane.rows[pane.view - 1];
  const lines = [['view', `${Math.max(0, pane.view)} of ${pane.rows.length}`]];
  if (panes.length > 1) lines.unshift(['run', facts[pane.run]?.name ?? '']);
  if (!row) return lines;
  const { occupied, planes } = pane.voxels;
  const as_committed = occupied === row.occupied && planes === row.planes && row.same_digest;
  lines.push(
    ['Occupied', `${number(occupied)} voxels`],
    ['planes', `${number(planes)} voxels`],
    ['as committed', as_committed ? 'yes' : 'NO: the mapper has another map'],
    ['area, quality', `${row.area_m2.toFixed(1)} m², ${row.quality.toFixed(3)}`],
    ['path, time', `${row.path_m.toFixed(1)} m, ${row.simulated_s.toFixed(0)} s simulated`],
    ['points', number(row.points)],
  );
  if (row.fitness !== undefined) lines.push(['fitness', `${row.fitness.toFixed(3)} of ${number(row.tried)} tried`]);
  return lines;
}

/// Why the planner did what it did, in its own words.
function words_of(pane) {
  const row = pane.rows[pane.view - 1];
  const lines = [];
  if (row?.reason) lines.push(['here', row.reason]);
  for (const why of row?.refused ?? []) lines.push(['refused', why]);
  if (pane.next) lines.push(['next', pane.next.reason || `view ${pane.next.view}`]);
  const stop = facts[pane.run]?.stop;
  if (stop && pane.view === pane.rows.length) lines.push(['end', `${stop.reason}. ${stop.detail}`]);
  return lines;
}

function list_of(pane, lines) {
  const list = document.createElement('dl');
  if (panes.length > 1) list.setAttribute('aria-label', facts[pane.run]?.name ?? '');
  for (const [term, text] of lines) {
    const name = document.createElement('dt');
    name.textContent = term;
    const value = document.createElement('dd');
    value.textContent = text;
    list.append(name, value);
  }
  return list;
}

function show_facts() {
  at('facts').replaceChildren(...panes.map((pane) => list_of(pane, lines_of(pane))));
  at('words').replaceChildren(...panes.map((pane) => list_of(pane, words_of(pane))));
  for (const pane of panes) {
    const name = facts[pane.run]?.name ?? 'run';
    pane.caption.textContent = `${name}, view ${Math.max(0, pane.view)}`;
    pane.canvas.setAttribute('aria-label', `The room as recovered in ${pane.caption.textContent}`);
    pane.element.dataset.view = pane.view;
    pane.element.dataset.occupied = pane.voxels.occupied;
    pane.element.dataset.planes = pane.voxels.planes;
  }
}

function show_about() {
  const said = panes.map((pane) => {
    const fact = facts[pane.run];
    if (!fact?.config) return fact?.note || 'waiting for a run';
    const { scene, seed, strategy } = fact.config;
    const end = fact.stop ? `${fact.stop.reason} after ${fact.stop.views} views`
      : fact.note || (fact.paused_after !== null ? 'paused' : 'going on');
    return `${scene || 'no scene'}, seed ${seed}, ${strategy}: ${end}`;
  });
  at('about').textContent = said.join(' | ');
  at('about').title = panes.map((pane) => facts[pane.run]?.stop?.detail ?? '').join(' | ');
}

function show_trouble(text) {
  at('trouble').textContent = text;
  at('trouble').hidden = text === '';
}

function show_runs() {
  at('runs').hidden = facts.length < 2;
  if (facts.length < 2 || at('runs').dataset.runs === facts.map((fact) => fact?.name).join()) return;
  at('runs').dataset.runs = facts.map((fact) => fact?.name).join();
  const choice = (title, side) => {
    const label = document.createElement('label');
    label.className = 'row';
    const select = document.createElement('select');
    select.id = `run-${side}`;
    if (side === 1) select.add(new Option('none', '-1'));
    facts.forEach((fact, run) => select.add(new Option(`${run + 1}: ${fact?.name ?? ''}`, run)));
    select.value = String(state.runs[side] ?? -1);
    select.addEventListener('change', () => {
      const runs = [...state.runs];
      runs[side] = Number(select.value);
      choose_runs(runs.filter((run) => run >= 0));
    });
    label.append(title, select);
    return label;
  };
  at('runs').replaceChildren(at('runs').firstElementChild, choice('show ', 0), choice('beside ', 1));
}

const curves = new Curves(at('curves'), (view) => { play(false); choose_view(view); });
function show_curves() {
  curves.set(panes.map((pane) => ({ name: facts[pane.run]?.name ?? '', rows: pane.rows })));
}

// What comes over the socket

const listener = {
  opened() {
    show_trouble('');
    facts = [];
    for (const pane of panes) {
      pane.forget();
      pane.cad_asked = false;
    }
    show_facts();
    ask();
  },
  closed() {
    show_trouble('The viewer does not answer; trying again.');
  },
  text(message) {
    const pane = pane_of(message.run);
    if (message.kind === 'facts') {
      facts.length = message.runs;
      facts[message.run] = message.facts;
      if (!state.runs.every((run) => run < message.runs)) return choose_runs([0]);
      if (pane && message.facts.config) {
        pane.set_config(message.facts.config);
        if (!placed) place();
        show_cut();
        if (state.layers.cad > 0) ask_for_cad();
      }
      show_runs();
      show_transport();
      show_about();
    } else if (message.kind === 'rows' && pane) {
      message.rows.forEach((row, i) => { pane.rows[message.first - 1 + i] = row; });
      show_curves();
      show_transport();
    } else if (message.kind === 'shown' && pane) {
      pane.show(message.view);
      curves.set_view(message.view);
      pane.next = null;
      show_facts();
      arrived();
    } else if (message.kind === 'next' && pane) {
      pane.set_next(message.next);
      show_facts();
      arrived();
    } else if (message.kind === 'no_cad') {
      show_trouble(`The CAD model cannot be shown: ${message.why}`);
    }
  },
  binary(kind, run, view, count, body) {
    const pane = pane_of(run);
    if (!pane) return;
    if (kind === kKind.blocks) pane.voxels.take(count, body);
    if (kind === kKind.scan) {
      pane.set_scan(body);
      draw_depth(pane.depth, pane.scan);
    }
    if (kind === kKind.tried) pane.set_tried(count, body);
    if (kind === kKind.cad) pane.set_cad(count, body);
    arrived();
  },
};

// Controls

function place() {
  placed = true;
  if (state.camera) {
    camera.position.fromArray(state.camera);
    target.fromArray(state.camera, 3);
    for (const pane of panes) pane.controls.update();
  } else {
    panes.find((pane) => pane.bounds)?.place_camera(false);
  }
  redraw();
}

function heights() {
  const { bounds } = panes.find((pane) => pane.bounds) ?? {};
  return bounds ? [bounds.min.z, bounds.max.z] : [0, 3];
}
function show_cut() {
  const [floor, ceiling] = heights();
  const cut = state.cut ?? [floor, ceiling];
  ['cut-low', 'cut-high'].forEach((id, i) => {
    at(id).value = Math.round((1000 * (cut[i] - floor)) / (ceiling - floor));
    at(`${id}-text`).textContent = `${cut[i].toFixed(2)} m`;
  });
}
function take_cut() {
  const [floor, ceiling] = heights();
  const height = (id) => floor + (Number(at(id).value) / 1000) * (ceiling - floor);
  const whole = at('cut-low').value === '0' && at('cut-high').value === '1000';
  state.cut = whole ? null : [height('cut-low'), height('cut-high')];
  show_cut();
  apply();
}
function apply() {
  for (const pane of panes) pane.apply(state);
  changed();
}

function make_layer_controls() {
  for (const [id, layer] of Object.entries(kLayers)) {
    const row = document.createElement('div');
    row.className = 'row';
    const label = document.createElement('label');
    label.className = `check layer-${id}`;
    const box = document.createElement('input');
    box.type = 'checkbox';
    box.id = `layer-${id}`;
    box.checked = state.layers[id] > 0;
    label.append(box, ` ${layer.name}`);
    const fade = document.createElement('input');
    fade.type = 'range';
    fade.id = `fade-${id}`;
    fade.min = 5;
    fade.max = 100;
    fade.value = Math.round(100 * (state.layers[id] || layer.strength || 0.5));
    fade.setAttribute('aria-label', `How strong: ${layer.name}`);
    const take = () => {
      state.layers[id] = box.checked ? Number(fade.value) / 100 : 0;
      fade.disabled = !box.checked;
      if (id === 'cad' && box.checked) ask_for_cad();
      apply();
    };
    fade.disabled = !box.checked;
    box.addEventListener('change', take);
    fade.addEventListener('input', take);
    row.append(label, fade);
    at('layers').append(row);
  }
}

/// Arrows orbit by five degrees, or pan with shift.
function move_by_key(event) {
  const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const away = camera.position.clone().sub(target);
  if (event.key in turns) {
    const [x, y] = turns[event.key];
    if (event.shiftKey) {
      const right = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 0);
      const up = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 1);
      const move = right.multiplyScalar(x).addScaledVector(up, -y).multiplyScalar(0.05 * away.length());
      target.add(move);
      camera.position.add(move);
    } else {
      const around = new THREE.Spherical().setFromVector3(new THREE.Vector3(away.x, away.z, -away.y));
      around.theta += (x * Math.PI) / 36;
      around.phi += (y * Math.PI) / 36;
      around.makeSafe();
      const turned = new THREE.Vector3().setFromSpherical(around);
      camera.position.copy(target).add(new THREE.Vector3(turned.x, -turned.z, turned.y));
    }
  } else if (event.key === '+' || event.key === '-') {
    camera.position.copy(target).addScaledVector(away, event.key === '+' ? 0.9 : 1 / 0.9);
  } else {
    return;
  }
  event.preventDefault();
  for (const pane of panes) pane.controls.update();
  changed();
}

const kKeys = {
  ' ': () => play(playing === null),
  ',': () => { play(false); choose_view((state.view ?? last_view()) - 1); },
  '.': () => { play(false); choose_view((state.view ?? last_view()) + 1); },
  f: () => { play(false); choose_view(null); },
  p: pause,
  s: step,
};
document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey || !(event.key in kKeys)) return;
  if (event.target.closest('button, select, summary, a') && event.key === ' ') return;
  if (event.target.matches('input[type=checkbox], input[type=radio]') && event.key === ' ') return;
  if (event.target.matches('select')) return;
  event.preventDefault();
  kKeys[event.key]();
});

/// Both panes side by side, as they are.
function picture() {
  redraw_at_rest();
  const whole = document.createElement('canvas');
  whole.width = panes.reduce((width, pane) => width + pane.canvas.width, 0);
  whole.height = Math.max(...panes.map((pane) => pane.canvas.height));
  const context = whole.getContext('2d');
  let left = 0;
  for (const pane of panes) {
    pane.render(false);
    context.drawImage(pane.canvas, left, 0);
    left += pane.canvas.width;
  }
  return whole;
}
function save_png() {
  const name = `${panes.map((pane) => facts[pane.run]?.name ?? 'run').join('-')}-view${panes[0].view}.png`;
  picture().toBlob((blob) => {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(blob);
    link.download = name.replaceAll(/[^\w.-]+/g, '_');
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
}

function make_controls() {
  make_layer_controls();
  at('transport').addEventListener('submit', (event) => event.preventDefault());
  at('previous').addEventListener('click', kKeys[',']);
  at('following').addEventListener('click', kKeys['.']);
  at('play').addEventListener('click', kKeys[' ']);
  at('view').addEventListener('input', () => { play(false); choose_view(Number(at('view').value)); });
  at('follow').addEventListener('change', () => { play(false); choose_view(at('follow').checked ? null : last_view()); });
  at('speed').value = String(state.speed);
  at('speed').addEventListener('change', () => {
    state.speed = Number(at('speed').value);
    if (playing !== null) play(true);
    changed();
  });
  at('pause').addEventListener('click', pause);
  at('step').addEventListener('click', step);
  for (const button of document.querySelectorAll('[name=colour]')) {
    button.checked = button.value === state.colour;
    button.addEventListener('change', () => { state.colour = button.value; apply(); });
  }
  at('backs').checked = state.backs;
  at('backs').addEventListener('change', () => { state.backs = at('backs').checked; apply(); });
  for (const id of ['cut-low', 'cut-high']) at(id).addEventListener('input', take_cut);
  at('home').addEventListener('click', () => { panes[0]?.bounds && panes[0].place_camera(false); changed(); });
  at('top').addEventListener('click', () => { panes[0]?.bounds && panes[0].place_camera(true); changed(); });
  at('png').addEventListener('click', save_png);
  new ResizeObserver(redraw).observe(at('panes'));
  window.addEventListener('hashchange', () => location.reload());
}

make_controls();
make_panes();
show_curves();
const connection = new Connection(listener);

/// For tests, and for measuring: so many pictures a second while the camera goes round, and of how many voxels.
window.nextview = {
  panes: () => panes,
  paused_after: (run) => facts[run]?.paused_after,
  async pictures_a_second(seconds) {
    const [pane] = panes;
    const gl = pane.renderer.getContext();
    const pixel = new Uint8Array(4);
    pane.dragged = true; // so that no picture of one at rest comes between
    const start = performance.now();
    let pictures = 0;
    while (performance.now() - start < 1000 * seconds) {
      const away = camera.position.clone().sub(target).applyAxisAngle(new THREE.Vector3(0, 0, 1), 0.05);
      camera.position.copy(target).add(away);
      pane.controls.update();
      pane.render(true);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // until it has been drawn
      pictures += 1;
      await new Promise((go_on) => { setTimeout(go_on, 0); });
    }
    pane.dragged = false;
    return { voxels: pane.voxels.voxels, pictures, rate: (1000 * pictures) / (performance.now() - start),
      renderer: pane.renderer_name, width: pane.canvas.width, height: pane.canvas.height };
  },
};
