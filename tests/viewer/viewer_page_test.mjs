// The page in a real browser, on real runs. Waits for what is to come, never for a time. With SCREENSHOTS in the
// environment, a folder, pictures of the page are left there.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';

const { PROGRAMS, PAGE, FOLDER, CHROMIUM, SCREENSHOTS } = process.env;
const { chromium } = createRequire(join(PAGE, 'package.json'))('playwright-core');
const kViews = 8;
const kPatience_ms = 120000;

const children = [];
function start(name, ...options) {
  const child = spawn(join(PROGRAMS, `nextview_${name}`), options.map(String), {
    env: { ...process.env, NEXTVIEW_CACHE: join(FOLDER, 'cache') },
  });
  children.push(child);
  child.said = '';
  child.waiting = [];
  const hear = (bytes) => {
    child.said += bytes;
    for (const look of child.waiting) look();
  };
  child.stdout.on('data', hear);
  child.stderr.on('data', hear);
  child.ended = new Promise((done) => { child.on('close', (status) => { child.status = status; done(status); }); });
  child.says = (pattern) => new Promise((done, fail) => {
    const look = () => {
      const match = child.said.match(pattern);
      if (match) done(match);
    };
    child.waiting.push(look);
    look();
    child.ended.then(() => fail(new Error(`nextview_${name} ended without ${pattern}: ${child.said}`)));
  });
  return child;
}

const run_options = (out, seed) => ['boxes', '--views', kViews, '--seed', seed, '--no-coverage', '--out', join(FOLDER, out)];
async function carry_out(out, seed) {
  const run = start('run', ...run_options(out, seed));
  assert.equal(await run.ended, 0, run.said);
}
function digests_of(out) {
  const [head, ...rows] = readFileSync(join(FOLDER, out, 'views.csv'), 'utf8').trim().split('\n').map((row) => row.split(','));
  return rows.map((row) => row[head.indexOf('map_digest')]);
}
async function view(...options) {
  const viewer = start('viewer', ...options);
  viewer.address = (await viewer.says(/http:\/\/127\.0\.0\.1:\d+\//))[0];
  return viewer;
}
const port_of = (address) => Number(new URL(address).port);

// What a page does wrong.
const faults = [];
function watch(page) {
  page.on('console', (message) => {
    // The browser itself says that a server it asks again is not there.
    const of_driver = message.text().includes('GPU stall due to ReadPixels'); // as this test looks at pictures
    if (['error', 'warning'].includes(message.type()) && !page.server_is_away && !of_driver) faults.push(message.text());
  });
  page.on('pageerror', (error) => faults.push(String(error)));
  page.on('request', (request) => {
    const { protocol, hostname } = new URL(request.url());
    if (!['data:', 'blob:'].includes(protocol) && hostname !== '127.0.0.1') faults.push(`asked ${request.url()}`);
  });
  page.setDefaultTimeout(kPatience_ms);
}

/// Until every pane holds a view.
const shows = (page, n) => page.waitForFunction((wanted) => {
  const panes = [...document.querySelectorAll('.pane')];
  return panes.length > 0 && panes.every((pane) => pane.dataset.view === String(wanted));
}, n);
/// Until the page holds the range image of the view it shows.
const has_scan = (page) => page.waitForFunction(() => window.nextview.panes().every((pane) => pane.scan));
const held = (page, index = 0) => page.evaluate((i) => {
  const pane = window.nextview.panes()[i];
  const row = pane.rows[pane.view - 1];
  const { occupied, planes } = pane.element.dataset;
  return { view: pane.view, occupied: Number(occupied), planes: Number(planes), committed: row,
    digests: pane.rows.map((one) => one.digest) };
}, index);
/// Of a canvas, how many different colours it has.
const colours = (page, selector) => page.evaluate((which) => {
  for (const pane of window.nextview.panes()) pane.render(false);
  const source = document.querySelector(which);
  const copy = document.createElement('canvas');
  Object.assign(copy, { width: source.width, height: source.height });
  const context = copy.getContext('2d');
  context.drawImage(source, 0, 0);
  const pixels = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
  return new Set(pixels).size;
}, selector);
async function screenshot(page, name) {
  if (SCREENSHOTS) await page.screenshot({ path: join(SCREENSHOTS, `${name}.png`) });
}
async function set_slider(page, id, value) {
  await page.locator(`#${id}`).evaluate((slider, to) => {
    slider.value = to;
    slider.dispatchEvent(new Event('input', { bubbles: true }));
  }, value);
}

const tests = [];
const test = (name, what) => tests.push([name, what]);
let browser;
let viewer;
let page;
async function new_page(address, options = {}) {
  const made = await (await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options })).newPage();
  watch(made);
  await made.goto(address);
  return made;
}

test('as many voxels as the commit, at the newest view and at every one scrubbed to', async () => {
  await shows(page, kViews);
  for (const n of [kViews, 3, 1, kViews - 1, 2]) {
    await set_slider(page, 'view', n);
    await shows(page, n);
    const { view: shown, occupied, planes, committed, digests } = await held(page);
    assert.equal(shown, n);
    assert.equal(committed.view, n);
    assert.ok(occupied > 100);
    assert.equal(occupied, committed.occupied);
    assert.equal(planes, committed.planes);
    assert.ok(committed.same_digest);
    assert.deepEqual(digests, digests_of('one'));
    assert.equal(await page.locator('#view-text').textContent(), `${n} of ${kViews}`);
  }
});

test('the room, and a picture of depth that is not blank', async () => {
  await set_slider(page, 'view', 5);
  await shows(page, 5);
  await has_scan(page);
  assert.ok(await colours(page, '.depth') > 20);
  assert.ok(await colours(page, '.pane canvas') > 100);
  assert.equal(await page.locator('#curves canvas').count(), 4);
  assert.match(await page.locator('#facts').textContent(), /as committedyes/);
  await screenshot(page, 'desktop');
});

test('squares drawn on the processor look like the shader\'s', async () => {
  const drawn = await page.evaluate(() => {
    const [pane] = window.nextview.panes();
    const picture = () => {
      pane.renderer.render(pane.scene, pane.camera);
      const gl = pane.renderer.getContext();
      const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
      gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      return pixels;
    };
    const differing = (a, b) => {
      let count = 0;
      for (let i = 0; i < a.length; i += 4) {
        count += [0, 1, 2].some((channel) => Math.abs(a[i + channel] - b[i + channel]) > 12);
      }
      return count / (a.length / 4);
    };
    pane.render(false);
    pane.draw_voxels(true);
    const squares = picture();
    pane.splats.object.visible = false;
    const without = picture();
    pane.voxels.draw_as('sprites');
    pane.voxels.upload();
    const sprites = picture();
    return { of_twin: differing(squares, sprites), of_none: differing(squares, without) };
  });
  assert.ok(drawn.of_none > 0.2, `voxels in ${drawn.of_none} of the picture`);
  assert.ok(drawn.of_twin < 0.02, `${drawn.of_twin} of the picture differs`);
});

test('layers, cut and colour change the picture', async () => {
  const drawn = () => page.evaluate(() => {
    const [pane] = window.nextview.panes();
    pane.render(false);
    return pane.canvas.toDataURL();
  });
  let before = await drawn();
  const differs = async (what) => {
    const now = await drawn();
    assert.notEqual(now, before, what);
    before = now;
  };
  for (const id of ['surface', 'planes', 'points', 'sensor', 'path', 'poses', 'tried', 'next']) {
    await page.locator(`#layer-${id}`).uncheck();
    await differs(`without ${id}`);
  }
  await page.locator('#layer-surface').check();
  await differs('with the surface again');
  await page.locator('[name=colour][value=label]').check();
  await differs('by label');
  await page.locator('#backs').check();
  await differs('with the backs of walls');
  await set_slider(page, 'cut-high', 500);
  await differs('cut');
  await set_slider(page, 'fade-surface', 30);
  await differs('faded');
  await page.locator('#top').click();
  await differs('from above');
});

test('the CAD model', async () => {
  await page.locator('#layer-cad').check();
  await page.waitForFunction(() => window.nextview.panes()[0].cad_triangles > 0);
  const triangles = readFileSync(join(import.meta.dirname ?? new URL('.', import.meta.url).pathname,
    '../../scenes/boxes/boxes.obj'), 'utf8').split('\n').filter((line) => line.startsWith('f '));
  const corners = triangles.reduce((sum, line) => sum + line.trim().split(/\s+/).length - 3, 0);
  assert.equal(await page.evaluate(() => window.nextview.panes()[0].cad_triangles), corners);
  await screenshot(page, 'cad');
});

test('a link brings back what is shown', async () => {
  await page.waitForFunction(() => location.hash.includes('cad:') && location.hash.includes('camera='));
  await page.locator('.pane canvas').focus();
  const before = await page.evaluate(() => location.hash);
  await page.keyboard.press('ArrowLeft');
  await page.waitForFunction((old) => location.hash !== old, before);
  const address = await page.evaluate(() => location.href);
  const other = await new_page(address);
  await shows(other, 5);
  assert.equal(await other.locator('#layer-cad').isChecked(), true);
  assert.equal(await other.locator('#layer-path').isChecked(), false);
  assert.equal(await other.locator('[name=colour][value=label]').isChecked(), true);
  assert.equal(await other.locator('#cut-high').inputValue(), '500');
  assert.equal(await other.evaluate(() => location.hash), new URL(address).hash);
  await other.context().close();
});

test('all of it by keyboard', async () => {
  const fresh = await new_page(viewer.address);
  await shows(fresh, kViews);
  const wanted = await fresh.evaluate(() => [...document.querySelectorAll('button, input, select, summary, .pane canvas')]
    .filter((one) => one.checkVisibility() && !one.disabled && !(one.type === 'radio' && !one.checked))
    .map((one, i) => { one.dataset.stop = i; return one.id || one.tagName; }));
  const reached = new Set();
  for (let press = 0; press < 3 * wanted.length && reached.size < wanted.length; press += 1) {
    await fresh.keyboard.press('Tab');
    const stop = await fresh.evaluate(() => document.activeElement?.dataset.stop);
    if (stop !== undefined) reached.add(stop);
  }
  assert.deepEqual(wanted.filter((_, i) => !reached.has(String(i))), [], 'not reached by Tab');
  const without_name = await fresh.evaluate(() => [...document.querySelectorAll('button, input, select, canvas[role]')]
    .filter((one) => !(one.textContent.trim() || one.getAttribute('aria-label') || one.labels?.length)).map((one) => one.outerHTML));
  assert.deepEqual(without_name, []);
  await fresh.locator('.pane canvas').focus();
  await fresh.keyboard.press(',');
  await shows(fresh, kViews - 1);
  await fresh.keyboard.press(',');
  await shows(fresh, kViews - 2);
  await fresh.keyboard.press('.');
  await shows(fresh, kViews - 1);
  await fresh.keyboard.press('f');
  await shows(fresh, kViews);
  await fresh.locator('#speed').selectOption('16');
  await fresh.locator('.pane canvas').focus();
  await fresh.keyboard.press(' '); // plays from the start to the end
  await fresh.waitForFunction(() => document.getElementById('play').textContent === 'Stop');
  await fresh.waitForFunction(() => document.getElementById('play').textContent === 'Play');
  await shows(fresh, kViews);
  await fresh.context().close();
});

test('a picture is saved', async () => {
  const [download] = await Promise.all([page.waitForEvent('download'), page.locator('#png').click()]);
  assert.match(download.suggestedFilename(), /^one-view5\.png$/);
  const bytes = readFileSync(await download.path());
  assert.equal(bytes.subarray(1, 4).toString(), 'PNG');
  assert.ok(bytes.length > 5000);
});

test('two runs side by side', async () => {
  const two = await new_page(`${viewer.address}#runs=0,1`);
  await shows(two, kViews);
  await set_slider(two, 'view', 4);
  await shows(two, 4);
  for (const [index, out] of [[0, 'one'], [1, 'two']]) {
    const { occupied, committed, digests } = await held(two, index);
    assert.equal(occupied, committed.occupied);
    assert.deepEqual(digests, digests_of(out));
  }
  assert.notDeepEqual(digests_of('one'), digests_of('two'));
  assert.equal(await two.locator('.pane').count(), 2);
  await has_scan(two);
  await screenshot(two, 'two');
  await two.locator('#run-1').selectOption('-1');
  await two.waitForFunction(() => document.querySelectorAll('.pane').length === 1);
  await shows(two, 4);
  await two.context().close();
});

test('readable at the width of a phone', async () => {
  const phone = await new_page(viewer.address, { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true });
  await shows(phone, kViews);
  await has_scan(phone);
  const layout = await phone.evaluate(() => {
    const texts = [...document.querySelectorAll('p, dt, dd, label, button, output, summary, legend, h1, figcaption, option')]
      .filter((one) => one.checkVisibility());
    return {
      width: document.documentElement.scrollWidth,
      smallest: Math.min(...texts.map((one) => parseFloat(getComputedStyle(one).fontSize))),
      outside: texts.filter((one) => one.getBoundingClientRect().right > innerWidth + 1).map((one) => one.textContent),
      picture: document.querySelector('.pane').getBoundingClientRect().height,
      buttons: Math.min(...[...document.querySelectorAll('button')].filter((one) => one.checkVisibility())
        .map((one) => one.getBoundingClientRect().height)),
    };
  });
  assert.equal(layout.width, 390);
  assert.ok(layout.smallest >= 12, `${layout.smallest} px`);
  assert.deepEqual(layout.outside, []);
  assert.ok(layout.picture > 300);
  assert.ok(layout.buttons >= 30);
  await screenshot(phone, 'phone');
  if (SCREENSHOTS) await phone.screenshot({ path: join(SCREENSHOTS, 'phone-whole.png'), fullPage: true });
  await phone.context().close();
});

test('a viewer that comes back is found again', async () => {
  page.server_is_away = true;
  viewer.kill('SIGTERM');
  await viewer.ended;
  await page.waitForFunction(() => !document.getElementById('trouble').hidden);
  viewer = await view(join(FOLDER, 'two'), '--port', port_of(viewer.address));
  await page.waitForFunction(() => document.getElementById('trouble').hidden);
  await shows(page, 5);
  const { occupied, committed, digests } = await held(page);
  assert.equal(occupied, committed.occupied, 'nothing is left of the run before');
  assert.deepEqual(digests, digests_of('two'));
  page.server_is_away = false;
});

test('a run that is watched, paused and stepped, and is the same', async () => {
  const run = start('run', ...run_options('watched', 1), '--view', '--paused');
  const [address] = await run.says(/http:\/\/127\.0\.0\.1:\d+\//);
  const live = await new_page(address);
  await shows(live, 0);
  const paused_after = () => live.evaluate(() => window.nextview.paused_after(0));
  assert.equal(await paused_after(), 0);
  let last = 0;
  for (let step = 0; step < 3; step += 1) {
    await live.locator('#step').click();
    await live.waitForFunction((before) => window.nextview.panes()[0].view > before, last);
    last = (await held(live)).view;
  }
  assert.ok(last >= 3 && last <= kViews);
  await screenshot(live, 'paused');
  await live.locator('#pause').click(); // lets it go on
  await shows(live, kViews);
  await live.waitForFunction(() => document.getElementById('about').textContent.includes('view_limit after 8 views'));
  const { occupied, committed, digests } = await held(live);
  assert.equal(occupied, committed.occupied);
  await run.says(/until Ctrl-C/);
  assert.deepEqual(digests_of('watched'), digests_of('one'), 'the run is the same as without a viewer');
  assert.deepEqual(digests, digests_of('one'));
  run.kill('SIGINT');
  live.server_is_away = true;
  assert.equal(await run.ended, 0, run.said);
  await live.context().close();
});

test('a run that is under way is caught up with', async () => {
  const run = start('run', ...run_options('joined', 1), '--view', '--paused', '--verbose', '--no-private');
  const [, url] = await run.says(/bus: (\S+), run/);
  const [first] = await run.says(/http:\/\/127\.0\.0\.1:\d+\//);
  const one = await new_page(first);
  await shows(one, 0);
  for (let last = 0; last < 2; last = (await held(one)).view) {
    await one.locator('#step').click();
    await one.waitForFunction((before) => window.nextview.panes()[0].view > before, last);
  }
  const late = await view('--attach', url, '--port', 0);
  const two = await new_page(late.address);
  await two.waitForFunction(() => window.nextview.panes()[0].view >= 2);
  await one.locator('#pause').click();
  await shows(two, kViews);
  const { occupied, committed, digests } = await held(two);
  assert.equal(occupied, committed.occupied);
  assert.deepEqual(digests, digests_of('one'));
  one.server_is_away = two.server_is_away = true;
  await run.says(/until Ctrl-C/);
  run.kill('SIGTERM');
  await run.ended;
});

let failed = 0;
try {
  await carry_out('one', 1);
  await carry_out('two', 2);
  browser = await chromium.launch({
    executablePath: CHROMIUM,
    args: ['--no-sandbox', '--disable-gpu', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic',
      '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync',
      '--disable-dev-shm-usage'],
  });
  viewer = await view(join(FOLDER, 'one'), join(FOLDER, 'two', 'run.lcmlog'), '--port', 0);
  page = await new_page(viewer.address);
  for (const [name, what] of tests) {
    try {
      await what();
      assert.deepEqual(faults, [], 'errors in the browser');
      console.log(`ok: ${name}`);
    } catch (error) {
      failed += 1;
      console.log(`FAILED: ${name}\n${error.stack}`);
      if (faults.length > 0) console.log(`in the browser: ${faults.splice(0).join('\n')}`);
    }
  }
} catch (error) {
  failed += 1;
  console.log(error.stack);
} finally {
  await browser?.close();
  for (const child of children) if (child.status === undefined) child.kill('SIGTERM');
  await Promise.all(children.map((child) => child.ended));
}
if (failed > 0) process.exit(1);
