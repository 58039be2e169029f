#!/usr/bin/env node
// SPDX-License-Identifier: BSD-3-Clause
// use_viewer.js MODULES CHROMIUM PAGE: uses the viewer of a page with mouse, fingers and keys as a visitor does, on a screen of
// 1,280 and one of 375 pixels. PAGE shows an upright square of side 2 m in the plane y = 0 from 3 m before it at 60 degrees, has a
// photograph as second place, and text around the viewer. Prints a line for each thing that is not as it should be.
const path = require('path');
const [modules, executablePath, file] = process.argv.slice(2);
const { chromium } = require(path.resolve(modules, 'playwright-core'));
const flags = ['--no-sandbox', '--disable-dev-shm-usage', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
let failures = 0;
const expect = (ok, what) => { if (!ok) { ++failures; console.log('not so: ' + what); } };

const camera = page => page.evaluate(() => {
  const { heading, pitch, distance, target } = document.getElementById('fresco-viewer').viewer.camera;
  return { heading, pitch, distance, target };
});
const scrolled = page => page.evaluate(() => window.scrollY);
/// Camera and page have stopped.
const arrived = async page => {
  const state = async () => JSON.stringify([await camera(page), await scrolled(page)]);
  for (let last = '', now = await state(); last !== now; now = await state()) {
    last = now;
    await page.waitForTimeout(300);
  }
};
/// The page is at its top and stays there.
const atTop = async page => {
  do {
    await page.evaluate(() => scrollTo(0, 0));
    await arrived(page);
  } while ((await scrolled(page)) > 0);
};
const settled = page => page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));
const words = page => page.textContent('.fresco-viewer output');
const press = (page, name) => page.click(`.fresco-viewer button:text-is("${name}")`);

async function open(browser, options) {
  const context = await browser.newContext({ ...options, acceptDownloads: true }), page = await context.newPage();
  page.setDefaultTimeout(60000);
  page.on('pageerror', error => expect(false, 'a page without errors: ' + error.message));
  page.on('request', request => expect(/^(file|data|blob):/.test(request.url()), 'a page that asks nobody: ' + request.url()));
  await page.goto('file://' + path.resolve(file));
  await page.waitForFunction(() => ['ready', 'error'].includes(document.getElementById('fresco-viewer').dataset.state));
  const { left, top, width, height } = await page.evaluate(() => document.querySelector('canvas').getBoundingClientRect().toJSON());
  expect(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'no wider than the screen');
  return { page, x: left + width / 2, y: top + height / 2, metre: height * Math.min(1, Math.max(width / height, 0.6)) / (2 * 3 * Math.tan(Math.PI / 6)) }; // upright screens see as wide
}

async function measure(page, kind, points) {
  await press(page, kind);
  for (const [x, y] of points) await page.mouse.click(x, y);
  await settled(page);
  const said = await words(page);
  await press(page, kind);
  return Number((/: ([0-9.]+)/.exec(said) || [])[1]);
}

async function useMouse(browser) {
  const { page, x, y, metre } = await open(browser, { viewport: { width: 1280, height: 800 } });
  await page.mouse.move(x, y);
  await page.mouse.wheel(0, 120);
  await page.waitForFunction(() => window.scrollY > 0);
  expect((await camera(page)).target[1] === -3, 'the wheel scrolls the page until the model was clicked');
  await page.evaluate(() => scrollTo(0, 0));
  await settled(page);
  const distance = await measure(page, 'Distance', [[x - 0.8 * metre, y], [x + 0.7 * metre, y]]);
  expect(Math.abs(distance - 1.5) < 0.02, `a distance of 1.5 m, not ${distance}`);
  const height = await measure(page, 'Height', [[x - 0.8 * metre, y - 0.5 * metre], [x + 0.5 * metre, y + 0.7 * metre]]);
  expect(Math.abs(height - 1.2) < 0.02, `a height of 1.2 m, not ${height}`);
  const corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5]];
  const area = await measure(page, 'Area', corners.map(([a, b]) => [x + a * metre, y + b * metre]));
  expect(Math.abs(area - 1) < 0.03, `an area of 1 m2, not ${area}`);
  await press(page, 'Distance');
  await page.mouse.click(x + 1.3 * metre, y);
  expect(/no surface/.test(await words(page)), 'a click beside the surface says so');
  await press(page, 'Distance');
  await press(page, 'Clear');
  await settled(page);
  expect(await page.evaluate(() => document.querySelector('.measures').children.length === 0), 'cleared measures are gone');
  const before = await camera(page);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y + 20, { steps: 4 });
  await page.mouse.up();
  const after = await camera(page);
  expect(after.heading !== before.heading && after.pitch !== before.pitch, 'a drag turns');
  await page.mouse.wheel(0, -120);
  await settled(page);
  expect((await scrolled(page)) === 0 && (await camera(page)).target[1] !== -3, 'the wheel moves a model that has the focus');
  await page.selectOption('.fresco-viewer select', { index: 2 });
  expect(await page.isVisible('.fresco-viewer .photograph'), 'the photograph lies over the model');
  await page.fill('.fresco-viewer label:has-text("Photograph") input', '0.25');
  expect(await page.evaluate(() => document.querySelector('.photograph').style.opacity === '0.25'), 'the photograph fades');
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 40, y, { steps: 3 });
  await page.mouse.up();
  expect(!await page.isVisible('.fresco-viewer .photograph'), 'the photograph goes when the view turns away from it');
  const download = page.waitForEvent('download');
  await press(page, 'Save picture');
  expect((await download).suggestedFilename() === 'model.png', 'the picture is saved');
  await press(page, 'From above');
  expect((await camera(page)).distance > 0, 'a view from above');
  await press(page, 'Full screen');
  await page.waitForFunction(() => document.fullscreenElement !== null);
  await press(page, 'Full screen');
  await page.waitForFunction(() => document.fullscreenElement === null);
  await page.context().close();
}

async function useFingers(browser) {
  const { page, x, y, metre } = await open(browser, { viewport: { width: 375, height: 700 }, hasTouch: true, isMobile: true });
  const devtools = await page.context().newCDPSession(page);
  const touch = (type, points) => devtools.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([px, py], id) => ({ x: px, y: py, id })) });
  const drag = async (from, to) => {
    await touch('touchStart', from);
    for (let k = 1; k <= 8; ++k) { await touch('touchMove', from.map(([a, b], i) => [a + (to[i][0] - a) * k / 8, b + (to[i][1] - b) * k / 8])); await page.waitForTimeout(16); }
    await touch('touchEnd', []);
    await arrived(page);
  };
  const start = await camera(page);
  await drag([[x, y + 60]], [[x, y - 120]]);
  expect((await scrolled(page)) > 50 && (await camera(page)).heading === start.heading, 'a finger scrolls the page past the model');
  await atTop(page);
  await page.touchscreen.tap(x, y);
  await page.waitForFunction(() => document.querySelector('.fresco-viewer').contains(document.activeElement));
  await drag([[x - 60, y]], [[x + 60, y + 30]]);
  expect((await scrolled(page)) === 0 && (await camera(page)).heading !== start.heading, 'after a tap a finger turns');
  const turned = await camera(page);
  await drag([[x - 30, y], [x + 30, y]], [[x - 90, y], [x + 90, y]]);
  expect(Math.hypot(...(await camera(page)).target.map((v, i) => v - turned.target[i])) > 0.05, 'two fingers come nearer');
  await page.selectOption('.fresco-viewer select', { index: 1 });
  await arrived(page);
  await page.tap('.fresco-viewer button:text-is("Distance")');
  await page.touchscreen.tap(x - 0.5 * metre, y);
  await page.touchscreen.tap(x + 0.5 * metre, y);
  await settled(page);
  const distance = Number((/: ([0-9.]+)/.exec(await words(page)) || [])[1]);
  expect(Math.abs(distance - 1) < 0.05, `a distance of 1 m with fingers, not ${distance}`);
  await page.touchscreen.tap(x, y - page.viewportSize().height); // nothing there
  await page.evaluate(() => document.activeElement.blur());
  await drag([[x, y + 60]], [[x, y - 120]]);
  expect((await scrolled(page)) > 50, 'a finger scrolls again once the model has lost the focus');
  await page.context().close();
}

async function useKeys(browser) {
  const { page } = await open(browser, { viewport: { width: 1280, height: 800 } });
  const reached = [];
  let inside = false, left = false;
  for (let k = 0; k < 40 && !left; ++k) {
    await page.keyboard.press('Tab');
    const at = await page.evaluate(() => {
      const e = document.activeElement, ring = getComputedStyle(e);
      const root = e.closest('.fresco-viewer'), frame = root && getComputedStyle(root, '::after').borderTopWidth;
      return { name: e.tagName === 'CANVAS' ? 'model' : e.textContent || e.ariaLabel, inside: !!root,
               seen: e.tagName === 'CANVAS' ? parseFloat(frame) > 0 : ring.outlineStyle !== 'none' && parseFloat(ring.outlineWidth) > 0 };
    });
    left = inside && !at.inside;
    inside = at.inside;
    if (!inside) continue;
    reached.push(at.name);
    expect(at.seen, 'the focus is seen on ' + at.name);
  }
  expect(left, 'Tab leaves the viewer');
  for (const name of ['model', 'From above', 'Walk', 'Distance', 'Height', 'Area', 'Clear', 'Full screen', 'Save picture'])
    expect(reached.includes(name), 'keys reach ' + name);
  await page.focus('canvas');
  const before = await camera(page);
  // A busy machine draws seldom: keys are held until something was drawn.
  const hold = async (key, has) => {
    await page.keyboard.down(key);
    for (let k = 0; k < 100 && !has(await camera(page)); ++k) await page.waitForTimeout(100);
    await page.keyboard.up(key);
  };
  await hold('ArrowLeft', at => at.heading < before.heading);
  await hold('w', at => Math.hypot(...at.target.map((v, i) => v - before.target[i])) > 0.01);
  const after = await camera(page);
  expect(after.heading < before.heading, 'an arrow key turns');
  expect(Math.hypot(...after.target.map((v, i) => v - before.target[i])) > 0.01, 'W walks');
  await page.focus('.fresco-viewer label:has-text("Cut at") input');
  const cut = () => page.evaluate(() => document.getElementById('fresco-viewer').viewer.cut), whole = await cut();
  for (let k = 0; k < 10; ++k) await page.keyboard.press('ArrowLeft');
  expect((await cut()) < whole, 'keys move the cut');
  await page.focus('canvas');
  await page.keyboard.press('Escape');
  expect(await page.evaluate(() => document.activeElement.tagName !== 'CANVAS'), 'Escape leaves the model');
  await page.context().close();
}

(async () => {
  const browser = await chromium.launch({ executablePath, args: flags });
  for (const use of [useMouse, useFingers, useKeys])
    await use(browser).catch(error => expect(false, `${use.name} comes to its end: ${error.message.split('\n')[0]}`));
  await browser.close();
  process.exit(failures > 0 ? 1 : 0);
})();
