"use strict";
// Draw the scene of this page: bodies that hang on nodes, moved by modes or by a crossing.

const COLOURS = { plate: 0x9aa7b4, member: 0x5a7596, spring: 0xd07a1e, mass: 0x8a3a3a };

function text(id) {
  // "<\/" stands for "</" in a script element; in a script's own strings both are the same
  return document.getElementById(id).textContent;
}

function modules() {
  const url = (code) => URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
  const core = url(text("core"));
  const three = url(text("three").replaceAll("./three.core.min.js", core));
  const controls = url(text("controls").replace("from 'three';", `from '${three}';`));
  return Promise.all([import(three), import(controls)]);
}

function bytes(coded) {
  return Uint8Array.from(atob(coded), (c) => c.charCodeAt(0)).buffer;
}
const floats = (coded) => new Float32Array(bytes(coded));
const whole = (coded) => new Uint32Array(bytes(coded));
const shorts = (coded) => new Int16Array(bytes(coded));

function make(tag, parent, content = "") {
  const one = document.createElement(tag);
  one.textContent = content;
  parent.append(one);
  return one;
}

function tick(parent, name, on, change, colour = null) {
  const label = make("label", parent);
  const box = make("input", label);
  box.type = "checkbox";
  box.checked = on;
  if (colour !== null) {
    const swatch = make("span", label);
    swatch.className = "swatch";
    swatch.style.background = `#${colour.toString(16).padStart(6, "0")}`;
  }
  label.append(name);
  box.addEventListener("change", () => change(box.checked));
  return box;
}

function start([THREE, { OrbitControls }]) {
  const scene = JSON.parse(text("scene"));
  const stage = document.getElementById("stage");
  const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  stage.append(renderer.domElement);
  const world = new THREE.Scene();
  world.background = new THREE.Color(0xeef1f4);
  world.add(new THREE.HemisphereLight(0xffffff, 0x8892a0, 2.2));
  const sun = new THREE.DirectionalLight(0xffffff, 1.6);
  sun.position.set(-0.5, -1, 2);
  world.add(sun);
  const camera = new THREE.PerspectiveCamera(35, 1, 0.05, 10000);
  camera.up.set(0, 0, 1);
  const controls = new OrbitControls(camera, renderer.domElement);
  const low = new THREE.Vector3(...scene.low);
  const high = new THREE.Vector3(...scene.high);
  const middle = low.clone().add(high).multiplyScalar(0.5);
  const size = Math.max(high.distanceTo(low), 1);

  const nodes = floats(scene.nodes);
  const bodies = scene.solids.map((solid) => body(solid));
  const shown = { storeys: scene.storeys.map(() => true), groups: {} };

  function body(solid) {
    const node = whole(solid.node);
    const arm = floats(solid.arm);
    const rest = new Float32Array(arm.length);
    for (let i = 0; i < node.length; i++) {
      for (let k = 0; k < 3; k++) rest[3 * i + k] = nodes[3 * node[i] + k] + arm[3 * i + k];
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(rest.slice(), 3));
    geometry.setIndex(new THREE.BufferAttribute(whole(solid.triangles), 1));
    geometry.computeBoundingSphere();
    geometry.boundingSphere.radius *= 1.5;
    const material = new THREE.MeshStandardMaterial({
      color: COLOURS[solid.kind], flatShading: true, roughness: 0.9, side: THREE.DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
    const mesh = new THREE.Mesh(geometry, material);
    world.add(mesh);
    return { solid, node, arm, rest, mesh, places: geometry.attributes.position };
  }

  function appear() {
    for (const one of bodies) {
      one.mesh.visible = shown.storeys[one.solid.storey] && shown.groups[one.solid.name];
    }
    redraw();
  }

  // Motions: each returns six numbers a node (three of crossings), and is shown times a factor.
  const modes = scene.modes.map((mode) => ({ ...mode, motion: shorts(mode.motion) }));
  const crossing = scene.crossing && {
    ...scene.crossing,
    nodes: whole(scene.crossing.nodes),
    normals: floats(scene.crossing.normals),
    motion: shorts(scene.crossing.motion),
  };
  const moved = new Float32Array(2 * nodes.length);
  const state = { what: -1, frame: 0, playing: true, larger: 0, phase: 0 };

  function apply() {
    for (const one of bodies) {
      const { node, arm, rest, places } = one;
      const to = places.array;
      for (let i = 0; i < node.length; i++) {
        const n = 6 * node[i], a = 3 * i;
        const [x, y, z] = [arm[a], arm[a + 1], arm[a + 2]];
        const [p, q, r] = [moved[n + 3], moved[n + 4], moved[n + 5]];
        to[a] = rest[a] + moved[n] + q * z - r * y;
        to[a + 1] = rest[a + 1] + moved[n + 1] + r * x - p * z;
        to[a + 2] = rest[a + 2] + moved[n + 2] + p * y - q * x;
      }
      places.needsUpdate = true;
    }
  }

  function still() {
    moved.fill(0);
  }

  function ofMode(mode, phase) {
    const by = (mode.scale / 32767) * 0.06 * size * 10 ** (state.larger / 20) * Math.sin(phase);
    for (let i = 0; i < moved.length; i++) moved[i] = mode.motion[i] * by;
  }

  function ofFrame(frame) {
    moved.fill(0);
    const by = factor();
    const n = crossing.nodes.length;
    const unit = crossing.largest / 32767;
    for (let i = 0; i < n; i++) {
      const u = crossing.motion[frame * n + i] * unit * by;
      for (let k = 0; k < 3; k++) moved[6 * crossing.nodes[i] + k] = u * crossing.normals[3 * i + k];
    }
  }

  function factor() {
    const base = 10 ** Math.round(Math.log10((0.04 * size) / crossing.largest));
    return base * 10 ** (state.larger / 10);
  }

  // What stands beside the model: supports, routes, points, wheels.
  const extras = { supports: new THREE.Group(), routes: new THREE.Group(), points: new THREE.Group() };
  Object.values(extras).forEach((group) => world.add(group));
  const unit = Math.min(Math.max(size / 80, 0.12), 0.6);
  const held = whole(scene.supports.node);
  if (held.length) {
    const cones = new THREE.InstancedMesh(
      new THREE.ConeGeometry(0.7 * unit, 1.2 * unit, 4).rotateX(Math.PI / 2).translate(0, 0, -0.6 * unit),
      new THREE.MeshStandardMaterial({ color: 0x2f8f5b }), held.length);
    const place = new THREE.Matrix4();
    held.forEach((n, i) => {
      place.makeTranslation(nodes[3 * n], nodes[3 * n + 1], nodes[3 * n + 2]);
      cones.setMatrixAt(i, place);
    });
    cones.frustumCulled = false;
    extras.supports.add(cones);
  }
  const tags = [];
  function tag(name, place, group) {
    const one = make("div", document.body, name);
    one.className = "tag";
    tags.push({ one, place, group });
  }
  for (const route of scene.routes) {
    const places = route.places.map((p) => new THREE.Vector3(p[0], p[1], p[2] + 0.3 * unit));
    const line = new THREE.BufferGeometry().setFromPoints(places);
    extras.routes.add(new THREE.Line(line, new THREE.LineBasicMaterial({ color: 0xc2410c })));
    const [from, to] = places.slice(-2);
    const way = to.clone().sub(from).normalize();
    extras.routes.add(new THREE.ArrowHelper(way, to.clone().addScaledVector(way, -2.5 * unit),
      2.5 * unit, 0xc2410c, 2 * unit, 1.1 * unit));
    tag(route.name, places[0], extras.routes);
  }
  for (const point of scene.points) {
    const ball = new THREE.Mesh(new THREE.SphereGeometry(0.6 * unit, 16, 12),
      new THREE.MeshStandardMaterial({ color: 0xb91c1c }));
    ball.position.set(...point.place);
    extras.points.add(ball);
    tag(point.name, ball.position, extras.points);
  }
  for (const part of [...extras.routes.children, ...extras.points.children]) {
    part.traverse((one) => {
      if (one.material) { one.material.depthTest = false; one.renderOrder = 2; }
    });
  }
  const wheels = new THREE.Group();
  world.add(wheels);
  const vehicles = crossing ? crossing.wheels.map((one) => vehicle(one)) : [];

  function vehicle(one) {
    const largest = Math.max(...one.forces.flat(), 1);
    const parts = one.contacts.map(() => {
      const wheel = new THREE.Mesh(new THREE.TorusGeometry(0.38, 0.14, 8, 20).rotateX(Math.PI / 2),
        new THREE.MeshStandardMaterial({ color: 0x22272e }));
      const arrow = new THREE.ArrowHelper(new THREE.Vector3(0, 0, -1), new THREE.Vector3(), 1, 0x7c3aed);
      wheels.add(wheel, arrow);
      return { wheel, arrow };
    });
    const hull = new THREE.Mesh(new THREE.BoxGeometry(1, 1, 1), new THREE.MeshStandardMaterial({
      color: 0xe0a526, transparent: true, opacity: 0.55 }));
    wheels.add(hull);
    return { one, parts, hull, largest };
  }

  // What is above the wheels is seen through while they pass.
  const roof = crossing ? scene.heights.findIndex((z) => z > crossing.wheels[0].places[0][0][2] + 0.5) : -1;
  function seeThrough(on) {
    for (const { solid, mesh } of bodies) {
      const thin = on && roof >= 0 && solid.storey >= roof;
      if (mesh.material.transparent === thin) continue;
      Object.assign(mesh.material, { transparent: thin, opacity: thin ? 0.25 : 1, depthWrite: !thin });
      mesh.material.needsUpdate = true;
    }
  }

  function sunk(place) {
    let best = Infinity, at = 0;
    for (let i = 0; i < crossing.nodes.length; i++) {
      const n = 3 * crossing.nodes[i];
      const d = (nodes[n] - place[0]) ** 2 + (nodes[n + 1] - place[1]) ** 2 + (nodes[n + 2] - place[2]) ** 2;
      if (d < best) { best = d; at = crossing.nodes[i]; }
    }
    return new THREE.Vector3(moved[6 * at], moved[6 * at + 1], moved[6 * at + 2]);
  }

  function drive(frame) {
    for (const { one, parts, hull, largest } of vehicles) {
      const places = one.places[frame].map((p) => new THREE.Vector3(...p).add(sunk(p)));
      const lead = places[0], last = places[places.length - 1];
      const before = one.places[Math.max(frame - 1, 0)][0], after = one.places[Math.min(frame + 1, one.places.length - 1)][0];
      const way = new THREE.Vector3(after[0] - before[0], after[1] - before[1], 0);
      const angle = way.length() > 1e-6 ? Math.atan2(way.y, way.x) : wheels.userData.angle || 0;
      wheels.userData.angle = angle;
      parts.forEach(({ wheel, arrow }, i) => {
        const on = one.on[frame][i];
        wheel.position.copy(places[i]).add(new THREE.Vector3(0, 0, 0.52));
        wheel.rotation.set(0, 0, angle);
        wheel.visible = on;
        arrow.visible = on;
        const length = Math.max((3 * one.forces[frame][i]) / largest, 0.05);
        arrow.position.copy(places[i]).add(new THREE.Vector3(0, 0, 1.1 + length));
        arrow.setLength(length, 0.5, 0.35);
      });
      const span = lead.distanceTo(last);
      hull.scale.set(span + 1.6, 2.3, 1.6);
      hull.position.copy(lead).add(last).multiplyScalar(0.5).add(new THREE.Vector3(0, 0, 1.75));
      hull.rotation.set(0, 0, angle);
      hull.visible = one.on[frame].some(Boolean);
    }
  }

  // The panel.
  const what = document.getElementById("what");
  const slider = document.getElementById("slider");
  const option = (value, name) => {
    const one = make("option", what, name);
    one.value = value;
  };
  option("rest", "at rest");
  if (crossing) option("crossing", `crossing: ${crossing.title}`);
  modes.forEach((mode, i) => option(String(i), `mode ${i + 1}: ${mode.frequency.toPrecision(4)} Hz`));
  what.value = crossing ? "crossing" : modes.length ? "0" : "rest";
  what.addEventListener("change", () => { state.frame = 0; state.phase = 0; frame(); });
  slider.addEventListener("input", () => { state.frame = Number(slider.value); pause(true); frame(); });
  const play = document.getElementById("play");
  const pause = (stop) => { state.playing = !stop; play.textContent = stop ? "Play" : "Pause"; };
  play.addEventListener("click", () => pause(state.playing));
  const larger = document.getElementById("larger");
  larger.addEventListener("input", () => { state.larger = Number(larger.value); frame(); });
  const storeys = document.getElementById("storeys");
  scene.storeys.forEach((name, i) => tick(storeys, name, true, (on) => { shown.storeys[i] = on; appear(); }));
  if (scene.storeys.length < 2) storeys.hidden = true;
  const groups = document.getElementById("groups");
  for (const one of bodies) {
    if (one.solid.name in shown.groups) continue;
    shown.groups[one.solid.name] = one.solid.kind !== "mass";
    tick(groups, one.solid.name, shown.groups[one.solid.name],
      (on) => { shown.groups[one.solid.name] = on; appear(); }, COLOURS[one.solid.kind]);
  }
  const others = document.getElementById("others");
  const named = { supports: held.length, routes: scene.routes.length, points: scene.points.length };
  for (const [name, n] of Object.entries(named)) {
    if (n) tick(others, name, true, (on) => { extras[name].visible = on; redraw(); });
  }
  let wires = null;
  tick(others, "mesh lines", false, (on) => {
    wires = wires || bodies.map((one) => {
      const lines = new THREE.Mesh(one.mesh.geometry, new THREE.MeshBasicMaterial(
        { color: 0x1d2630, wireframe: true, transparent: true, opacity: 0.25 }));
      one.mesh.add(lines);
      return lines;
    });
    wires.forEach((lines) => { lines.visible = on; });
    redraw();
  });
  const views = document.getElementById("views");
  const looks = { "3-D": [-0.7, -1, 0.75], plan: [0, -1e-3, 1], front: [0, -1, 0.05], side: [1, 0, 0.05] };
  for (const [name, way] of Object.entries(looks)) {
    make("button", views, name).addEventListener("click", () => look(way));
  }

  function look(way) {
    const aside = window.innerWidth > 640 ? 280 : 0;
    const half = Math.tan((camera.fov * Math.PI) / 360);
    const wide = Math.min(1, (window.innerWidth - aside) / window.innerHeight);
    const away = (0.5 * size) / half / wide * 1.05;
    camera.position.copy(middle).addScaledVector(new THREE.Vector3(...way).normalize(), away);
    controls.target.copy(middle);
    controls.update();
    redraw();
  }

  function frame() {
    const mode = modes[Number(what.value)];
    const timed = what.value === "crossing";
    document.getElementById("time").hidden = !timed;
    larger.parentElement.hidden = what.value === "rest";
    play.hidden = what.value === "rest";
    wheels.visible = timed;
    seeThrough(timed);
    const said = document.getElementById("said");
    const times = document.getElementById("times");
    if (timed) {
      slider.max = crossing.time.length - 1;
      slider.value = state.frame;
      ofFrame(state.frame);
      drive(state.frame);
      const n = crossing.nodes.length;
      let most = 0;
      for (let i = 0; i < n; i++) most = Math.max(most, Math.abs(crossing.motion[state.frame * n + i]));
      const sink = (1e3 * most * crossing.largest) / 32767;
      const forces = crossing.wheels.map((one) => one.forces[state.frame].reduce((sum, f, i) => sum + (one.on[state.frame][i] ? f : 0), 0));
      times.textContent = `${Number(factor().toPrecision(2)).toLocaleString("en")} times`;
      said.textContent = `${crossing.time[state.frame].toFixed(2)} s: the floor moves by up to ` +
        `${sink.toPrecision(3)} mm; ${(forces.reduce((a, b) => a + b, 0) / 1e3).toFixed(0)} kN on it`;
    } else if (mode) {
      ofMode(mode, state.phase);
      times.textContent = "not to scale";
      said.textContent = `mode ${Number(what.value) + 1} of ${modes.length} shown, ${mode.frequency.toPrecision(5)} Hz`;
    } else {
      still();
      said.textContent = "";
    }
    apply();
    redraw();
  }

  let due = false;
  function redraw() {
    due = true;
  }

  function label() {
    const at = new THREE.Vector3();
    for (const { one, place, group } of tags) {
      at.copy(place).project(camera);
      one.hidden = !group.visible || at.z > 1;
      one.style.left = `${(0.5 + 0.5 * at.x) * window.innerWidth}px`;
      one.style.top = `${(0.5 - 0.5 * at.y) * window.innerHeight}px`;
    }
  }

  function fit() {
    renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    renderer.setSize(window.innerWidth, window.innerHeight);
    camera.aspect = window.innerWidth / window.innerHeight;
    // the model stands in the part of the window that the panel leaves
    const aside = window.innerWidth > 640 ? 280 : 0;
    camera.setViewOffset(window.innerWidth, window.innerHeight, -aside / 2, 0, window.innerWidth, window.innerHeight);
    camera.updateProjectionMatrix();
    redraw();
  }

  let last = performance.now();
  let owed = 0;
  function turn(now) {
    const passed = Math.min((now - last) / 1000, 0.1);
    last = now;
    if (state.playing && what.value === "crossing") {
      owed += passed;
      const step = crossing.time[1] - crossing.time[0];
      const n = Math.floor(owed / step);
      if (n > 0) {
        owed -= n * step;
        state.frame = (state.frame + n) % crossing.time.length;
        frame();
      }
    } else if (state.playing && modes[Number(what.value)]) {
      state.phase += passed * Math.PI;
      frame();
    }
    if (due) {
      due = false;
      renderer.render(world, camera);
      label();
    }
    requestAnimationFrame(turn);
  }

  controls.addEventListener("change", redraw);
  window.addEventListener("resize", fit);
  fit();
  look(looks["3-D"]);
  // "#mode=2&phase=0.5", "#time=3.2", "#rest": a page that opens still, to be cited or printed
  const asked = new URLSearchParams(location.hash.slice(1));
  if (asked.has("rest")) what.value = "rest";
  if (asked.has("mode") && modes[Number(asked.get("mode")) - 1]) {
    what.value = String(Number(asked.get("mode")) - 1);
    state.phase = Math.PI * Number(asked.get("phase") || 0.5);
    pause(true);
  }
  if (asked.has("time") && crossing) {
    what.value = "crossing";
    const time = Number(asked.get("time"));
    state.frame = crossing.time.reduce((best, t, i) => Math.abs(t - time) < Math.abs(crossing.time[best] - time) ? i : best, 0);
    pause(true);
  }
  appear();
  frame();
  renderer.render(world, camera);
  label();
  document.body.dataset.state = "ready";
  document.body.dataset.triangles = String(renderer.info.render.triangles);
  requestAnimationFrame(turn);
}

modules().then(start).catch((error) => {
  console.error(error);
  const lost = document.createElement("p");
  lost.id = "lost";
  lost.textContent = `This browser could not draw the model: ${error.message}. WebGL is needed.`;
  document.body.append(lost);
  document.body.dataset.state = "lost";
});
