// How many pictures a second the page of nextview_viewer draws in Chromium, while its camera goes round:
//   node bench/view.mjs BUILD ADDRESS [VOXELS]
// of the run that a viewer shows at ADDRESS, or of so many voxels, made up: three walls of a room.
// On a machine that others use too the processor time a picture takes says more than how many there are a second.
import { readdirSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';

const [build, address, voxels] = process.argv.slice(2);
const { chromium } = createRequire(join(resolve(build), 'viewer-page/package.json'))('playwright-core');
const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-gpu', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic',
    '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'],
});

/// Processor time of all that this program has started, seconds.
function processor_s() {
  const processes = new Map();
  for (const name of readdirSync('/proc').filter((one) => /^\d+$/.test(one))) {
    try {
      const fields = readFileSync(`/proc/${name}/stat`, 'utf8').replace(/^.*\) /, '').split(' ');
      processes.set(Number(name), { parent: Number(fields[1]), ticks: Number(fields[11]) + Number(fields[12]) });
    } catch {
      // It has ended meanwhile.
    }
  }
  const is_ours = (id) => id === process.pid || (processes.has(id) && is_ours(processes.get(id).parent));
  return [...processes].reduce((sum, [id, { ticks }]) => sum + (id !== process.pid && is_ours(id) ? ticks : 0), 0) / 100;
}

try {
  const page = await (await browser.newContext({ viewport: { width: 1280, height: 800 } })).newPage();
  page.on('pageerror', (error) => console.error(error));
  await page.goto(address);
  await page.waitForFunction(() => window.nextview.panes()[0].view > 0);
  if (voxels) {
    await page.evaluate((count) => {
      const [pane] = window.nextview.panes();
      pane.voxels.clear();
      // A block of a wall holds 64 voxels.
      const side = Math.ceil(Math.sqrt(count / 64 / 3));
      const walls = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
      for (let at = 0; at < 3 * side * side && pane.voxels.voxels < count; at += 1) {
        const [across, u, v] = walls[at % 3];
        const block = [0, 0, 0];
        block[u] = Math.floor(at / 3) % side;
        block[v] = Math.floor(at / 3 / side);
        const words = [];
        for (let i = 0; i < 64; i += 1) {
          words.push(((i % 8) << (3 * u)) | (Math.floor(i / 8) << (3 * v)), (200 << 24) | (127 << (8 * across)));
        }
        pane.voxels.take_block(...block, new Uint32Array(words));
      }
      pane.bounds.min.set(0, 0, 0);
      pane.bounds.max.setScalar(0.8 * side);
      pane.place_camera(false);
    }, Number(voxels));
  }
  await page.evaluate(() => window.nextview.pictures_a_second(0.1)); // compiles the shaders, fills the buffer
  const before_s = processor_s();
  const measured = await page.evaluate(() => window.nextview.pictures_a_second(10));
  measured.processor_s_a_picture = (processor_s() - before_s) / measured.pictures;
  const bytes = await page.evaluate(() => window.nextview.panes()[0].voxels.bytes);
  console.log(JSON.stringify({ ...measured, bytes }));
} finally {
  await browser.close();
}
