// What is shown, in the page's address, so that a link brings it back.

/// The layers, and how strong each is unless the address says otherwise; 0: off.
export const kLayers = {
  surface: { name: 'surface', strength: 1 },
  planes: { name: 'occlusion planes', strength: 0.35 },
  points: { name: 'range image', strength: 1 },
  sensor: { name: 'sensor, frustum', strength: 1 },
  path: { name: 'path', strength: 1 },
  poses: { name: 'past poses', strength: 1 },
  tried: { name: 'tried next', strength: 1 },
  next: { name: 'way to the next', strength: 1 },
  cad: { name: 'CAD model', strength: 0 },
};

const rounded = (numbers) => numbers.map((x) => Number(x.toFixed(3))).join(',');

export function state_of_address(hash) {
  const said = new URLSearchParams(hash.replace(/^#/, ''));
  const numbers = (name, count) => {
    const values = (said.get(name) ?? '').split(',').map(Number);
    return values.length === count && values.every(Number.isFinite) ? values : null;
  };
  const view = Number(said.get('view'));
  const state = {
    view: said.has('view') && Number.isInteger(view) && view >= 0 ? view : null,
    runs: (said.get('runs') ?? '0').split(',').map(Number).filter((run) => Number.isInteger(run) && run >= 0).slice(0, 2),
    colour: said.get('colour') === 'label' ? 'label' : 'quality',
    backs: said.get('backs') === '1',
    cut: numbers('cut', 2),
    camera: numbers('camera', 6),
    speed: Number(said.get('speed')) || 4,
    layers: Object.fromEntries(Object.entries(kLayers).map(([id, layer]) => [id, layer.strength])),
  };
  if (state.runs.length === 0) state.runs = [0];
  for (const one of (said.get('layers') ?? '').split(',')) {
    const [id, strength] = one.split(':');
    if (id in state.layers && Number.isFinite(Number(strength))) {
      state.layers[id] = Math.min(1, Math.max(0, Number(strength)));
    }
  }
  return state;
}

export function address_of_state(state) {
  const said = new URLSearchParams();
  if (state.view !== null) said.set('view', state.view);
  if (state.runs.join() !== '0') said.set('runs', state.runs.join());
  if (state.colour !== 'quality') said.set('colour', state.colour);
  if (state.backs) said.set('backs', 1);
  if (state.cut) said.set('cut', rounded(state.cut));
  if (state.camera) said.set('camera', rounded(state.camera));
  if (state.speed !== 4) said.set('speed', state.speed);
  const layers = Object.entries(state.layers).filter(([id, strength]) => strength !== kLayers[id].strength);
  if (layers.length > 0) said.set('layers', layers.map(([id, strength]) => `${id}:${strength}`).join());
  return '#' + said.toString().replaceAll('%2C', ',').replaceAll('%3A', ':');
}
