// SPDX-License-Identifier: BSD-3-Clause
// Mouse, fingers and keys. The page keeps its own: a finger scrolls it until the model was tapped, the wheel until it has
// the focus, and Tab always leaves.
/// @param clicked(x, y) 0..1 from the upper left corner, without a drag between down and up
/// @return walk(seconds): moves on while keys are down, and tells whether they are
function listen(canvas, camera, changed, clicked) {
  const pointers = new Map(), keys = new Set(), still = 6; // pixels that a click may wander
  let wandered = 0;
  const active = () => document.activeElement === canvas || !!document.fullscreenElement;
  const touch = () => { canvas.style.touchAction = active() ? 'none' : 'pan-y'; };
  const span = () => { const [a, b] = [...pointers.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
  for (const name of ['focus', 'blur']) canvas.addEventListener(name, touch);
  document.addEventListener('fullscreenchange', touch);
  touch();
  canvas.addEventListener('contextmenu', e => e.preventDefault());
  canvas.addEventListener('pointerdown', e => {
    if (e.pointerType === 'mouse') canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(e.pointerId);
    if (!pointers.size) wandered = 0;
    pointers.set(e.pointerId, { x: e.clientX, y: e.clientY });
  });
  canvas.addEventListener('pointercancel', e => pointers.delete(e.pointerId));
  canvas.addEventListener('pointerup', e => {
    pointers.delete(e.pointerId);
    if (wandered > still || pointers.size || e.button > 0) return;
    const box = canvas.getBoundingClientRect();
    canvas.focus({ preventScroll: true });
    clicked((e.clientX - box.left) / box.width, (e.clientY - box.top) / box.height);
  });
  canvas.addEventListener('pointermove', e => {
    const last = pointers.get(e.pointerId);
    if (!last) return;
    const before = pointers.size === 2 ? span() : 0, dx = e.clientX - last.x, dy = e.clientY - last.y;
    wandered += Math.hypot(dx, dy);
    pointers.set(e.pointerId, { x: e.clientX, y: e.clientY });
    if (e.pointerType === 'touch' && !active()) return;
    const scale = Math.PI * camera.angle / 180 / canvas.clientHeight;
    const reach = scale * (camera.distance || 0.5 * camera.radius);
    if (pointers.size === 2) { camera.zoom(12 * Math.log(span() / Math.max(before, 1))); camera.move(-dx * reach / 2, dy * reach / 2, 0); }
    else if (e.buttons & 6 || e.shiftKey) camera.move(-dx * reach, dy * reach, 0);
    else if (camera.distance > 0) camera.turn(dx * 0.008, -dy * 0.008);
    else camera.turn(-dx * scale, dy * scale);
    changed();
  });
  canvas.addEventListener('wheel', e => {
    if (!active()) return;
    e.preventDefault(); camera.zoom(-Math.sign(e.deltaY)); changed();
  }, { passive: false });
  const moves = { w: [0, 0, 1], s: [0, 0, -1], a: [-1, 0, 0], d: [1, 0, 0], e: [0, 1, 0], q: [0, -1, 0] };
  const turns = { arrowup: [0, 1], arrowdown: [0, -1], arrowleft: [-1, 0], arrowright: [1, 0] };
  canvas.addEventListener('keydown', e => {
    const k = e.key.toLowerCase();
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    if (moves[k] || turns[k]) keys.add(k);
    else if (k === '+' || k === '-') camera.zoom(k === '+' ? 1 : -1);
    else if (k === 'enter') { e.preventDefault(); clicked(0.5, 0.5); return; }
    else if (k === 'escape') canvas.blur();
    else return;
    e.preventDefault(); changed();
  });
  canvas.addEventListener('keyup', e => keys.delete(e.key.toLowerCase()));
  canvas.addEventListener('blur', () => keys.clear());
  return seconds => {
    for (const key of keys)
      if (moves[key]) camera.move(...moves[key].map(v => 0.35 * camera.radius * seconds * v));
      else camera.turn(...turns[key].map(v => (camera.distance > 0 ? -1 : 1) * 1.2 * seconds * v));
    return keys.size > 0;
  };
}
