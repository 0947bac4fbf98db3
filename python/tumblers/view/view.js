import * as THREE from "three";
import { OrbitControls } from "three/OrbitControls";

const run = JSON.parse(document.getElementById("content").textContent);
const element = (id) => document.getElementById(id);
const vector = ([x, y, z]) => new THREE.Vector3(x, y, z);
const FIELD = "#7a3e9d", MOMENT = "#c00000";

// The substrate frame; on a slope it is turned so that gravity points down on the screen.
const world = new THREE.Group();
world.quaternion.setFromUnitVectors(vector(run.down).normalize(), new THREE.Vector3(0, 0, -1));

function extent() {
  const box = new THREE.Box3();
  for (const place of run.position) box.expandByPoint(vector(place));
  return box;
}

// Faces may be concave: earcut cuts them in the plane that shows most of them.
function bodyGeometry(faces) {
  const corners = [];
  for (const face of faces) {
    const points = face.map(vector);
    const normal = new THREE.Vector3();
    points.forEach((point, i) => normal.add(point.clone().cross(points[(i + 1) % points.length])));
    const size = [Math.abs(normal.x), Math.abs(normal.y), Math.abs(normal.z)];
    const left = size.indexOf(Math.max(...size));
    const [u, v] = [[1, 2], [2, 0], [0, 1]][left].map((k) => ["x", "y", "z"][k]);
    const flat = points.map((point) => new THREE.Vector2(point[u], point[v]));
    for (const triangle of THREE.ShapeUtils.triangulateShape(flat, [])) {
      const [a, b, c] = triangle.map((i) => points[i]);
      const turned = b.clone().sub(a).cross(c.clone().sub(a)).dot(normal) < 0;
      corners.push(a, ...(turned ? [c, b] : [b, c]));
    }
  }
  const geometry = new THREE.BufferGeometry().setFromPoints(corners);
  geometry.computeVertexNormals();
  return geometry;
}

function robotOf() {
  const robot = new THREE.Group();
  const offset = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
  const skin = new THREE.MeshStandardMaterial({ roughness: 0.75, ...offset });
  const body = new THREE.Mesh(bodyGeometry(run.faces), skin);
  body.castShadow = true;
  robot.add(body);
  const edges = new THREE.BufferGeometry().setFromPoints(run.creases.flat().map(vector));
  robot.add(new THREE.LineSegments(edges, new THREE.LineBasicMaterial({ color: 0x1c2126 })));
  return [robot, skin];
}

// An arrow; what the robot or the substrate hides of it shines through.
function arrow(colour, length) {
  const made = new THREE.Group();
  const solid = new THREE.MeshBasicMaterial({ color: colour });
  const faint = new THREE.MeshBasicMaterial({ color: colour, depthTest: false, transparent: true, opacity: 0.3 });
  const thick = 0.022 * run.size, head = 0.2 * run.size;
  const shaft = new THREE.CylinderGeometry(thick, thick, length - head, 12).translate(0, 0.5 * (length - head), 0);
  const tip = new THREE.ConeGeometry(3 * thick, head, 18).translate(0, length - 0.5 * head, 0);
  for (const part of [shaft, tip]) made.add(new THREE.Mesh(part, solid), new THREE.Mesh(part, faint));
  return made;
}
const UP = new THREE.Vector3(0, 1, 0);
const point = (made, direction) => made.quaternion.setFromUnitVectors(UP, direction);

function step(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return power * [1, 2, 5, 10].find((factor) => factor * power >= length);
}

// The substrate: a sheet with lines at round distances; on a relief the sheet and its lines across follow its height.
function substrateOf(box, cell) {
  const margin = 4 * run.size;
  const low = (value) => Math.floor((value - margin) / cell) * cell;
  const high = (value) => Math.ceil((value + margin) / cell) * cell;
  const [x0, x1, y0, y1] = [low(box.min.x), high(box.max.x), low(box.min.y), high(box.max.y)];
  const relief = run.relief;
  const height = (y) => {
    if (!relief.length) return 0;
    const place = Math.min(Math.max((y - relief[0][0]) / (relief[1][0] - relief[0][0]), 0), relief.length - 1.001);
    const k = Math.floor(place);
    return relief[k][1] + (place - k) * (relief[k + 1][1] - relief[k][1]);
  };
  const rows = relief.length ? [y0, ...relief.map(([y]) => y).filter((y) => y > y0 && y < y1), y1] : [y0, y1];
  const corners = [], lines = [];
  for (let k = 1; k < rows.length; k++) {
    const [a, b] = [rows[k - 1], rows[k]];
    const [p, q] = [new THREE.Vector3(x0, a, height(a)), new THREE.Vector3(x1, a, height(a))];
    const [r, s] = [new THREE.Vector3(x1, b, height(b)), new THREE.Vector3(x0, b, height(b))];
    corners.push(p, q, r, p, r, s);
    for (let x = x0; x < x1 + 0.5 * cell; x += cell) {
      lines.push(new THREE.Vector3(x, a, height(a)), new THREE.Vector3(x, b, height(b)));
    }
  }
  for (let y = y0; y < y1 + 0.5 * cell; y += cell) {
    lines.push(new THREE.Vector3(x0, y, height(y)), new THREE.Vector3(x1, y, height(y)));
  }
  const sheet = new THREE.BufferGeometry().setFromPoints(corners);
  sheet.computeVertexNormals();
  const offset = { polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 };
  const matter = { color: 0xdfe5ea, side: THREE.DoubleSide, ...offset };
  const group = new THREE.Group();
  const ground = new THREE.Mesh(sheet, new THREE.MeshLambertMaterial(matter));
  ground.receiveShadow = true;
  group.add(ground);
  const grid = new THREE.BufferGeometry().setFromPoints(lines);
  group.add(new THREE.LineSegments(grid, new THREE.LineBasicMaterial({ color: 0x9aa7b2 })));
  return group;
}

function trailOf() {
  const geometry = new THREE.BufferGeometry().setFromPoints(run.position.map(vector));
  const trail = new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: 0x33404a }));
  trail.frustumCulled = false;
  return trail;
}

// The row before a time, and how far the time is on the way to the next.
function place(time) {
  let [low, high] = [0, run.time.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (run.time[middle] <= time) low = middle; else high = middle;
  }
  return [low, (time - run.time[low]) / (run.time[high] - run.time[low])];
}

function start() {
  const canvas = element("scene");
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
  renderer.shadowMap.enabled = true;
  renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  const stage = new THREE.Scene();
  stage.background = new THREE.Color(0xeef2f5);
  stage.add(world);
  // The lights stand over the substrate, which looks the same on every slope.
  const sky = new THREE.HemisphereLight(0xffffff, 0x8a949c, 1.9);
  sky.position.set(0, 0, 1);
  const sun = new THREE.DirectionalLight(0xffffff, 1.8);
  const sunward = new THREE.Vector3(2, -1.5, 6).multiplyScalar(run.size);
  sun.castShadow = true;
  sun.shadow.mapSize.set(1024, 1024);
  Object.assign(sun.shadow.camera, {
    left: -2.5 * run.size, right: 2.5 * run.size, bottom: -2.5 * run.size, top: 2.5 * run.size,
    near: 0.5 * run.size, far: 12 * run.size,
  });
  sun.shadow.normalBias = 0.01 * run.size;
  world.add(sky, sun, sun.target);

  const box = extent();
  const cell = step(0.5 * run.size);
  const [robot, skin] = robotOf();
  const trail = trailOf();
  const moment = arrow(MOMENT, 1.35 * run.size), field = arrow(FIELD, 1.7 * run.size);
  point(moment, vector(run.moment).normalize());
  robot.add(moment);
  world.add(substrateOf(box, cell), robot, trail, field);

  const camera = new THREE.PerspectiveCamera(35, 1, 0.02 * run.size, 1e4 * run.size);
  camera.up.set(0, 0, 1);
  const controls = new OrbitControls(camera, canvas);
  const middle = new THREE.Vector3();
  const seen = new THREE.Vector3();

  const first = run.time[0], last = run.time.at(-1);
  let time = first, playing = false, before = null, stale = true, bent = 0;
  const rotation = [new THREE.Quaternion(), new THREE.Quaternion()];
  const colours = run.colours.map((colour) => new THREE.Color(colour));
  const entries = run.modes.map((mode, k) => legend(mode, run.colours[k]));
  legend("field", FIELD, "arrow");
  legend("magnetization", MOMENT, "arrow");
  element("slope").textContent = `${run.slope}, grid ${Number(cell.toPrecision(3))} mm`;

  function legend(words, colour, kind = "") {
    const entry = document.createElement("li");
    const patch = document.createElement("i");
    patch.style.background = colour;
    patch.className = kind;
    entry.append(patch, words);
    element("legend").append(entry);
    return entry;
  }

  function pose() {
    const [row, share] = place(time);
    const near = share < 0.5 ? row : row + 1;
    robot.position.copy(vector(run.position[row])).lerp(vector(run.position[row + 1]), share);
    rotation.forEach((turn, k) => turn.fromArray(run.orientation[row + k]).normalize());
    robot.quaternion.slerpQuaternions(rotation[0], rotation[1], share);
    const along = vector(run.field[row]).lerp(vector(run.field[row + 1]), share);
    field.visible = along.length() > 1e-6;
    if (field.visible) point(field, along.normalize());
    field.position.copy(robot.position);
    sun.target.position.copy(robot.position);
    sun.position.copy(robot.position).add(sunward);
    // The trail ends where the robot is, between two rows.
    const places = trail.geometry.attributes.position;
    places.setXYZ(bent, ...run.position[bent]);
    bent = row + 1;
    places.setXYZ(bent, ...robot.position.toArray());
    places.needsUpdate = true;
    trail.geometry.setDrawRange(0, row + 2);
    skin.color.copy(colours[run.mode[near]]);
    entries.forEach((entry, k) => entry.classList.toggle("now", k === run.mode[near]));
    const slow = last - first < 1 ? 4 : 3;
    element("clock").textContent = `${time.toFixed(slow)} of ${Number(last.toPrecision(6))} s`;
    const [x, y, z] = robot.position.toArray().map((value) => value.toFixed(4));
    element("position").textContent = `x ${x}, y ${y}, z ${z} mm`;
    element("time").value = time;
  }

  // Where the camera looks: at the robot, whose hops it does not follow.
  function target() {
    return seen.set(robot.position.x, robot.position.y, 0.4 * run.size).applyQuaternion(world.quaternion);
  }

  function follow() {
    const moved = target().clone().sub(controls.target);
    controls.target.add(moved);
    camera.position.add(moved);
  }

  function home() {
    controls.target.copy(target());
    const wide = Math.max(1, 1.1 / camera.aspect);
    camera.position.copy(controls.target).add(middle.set(5.8, -3.2, 2.9).multiplyScalar(run.size * wide));
    stale = true;
  }

  function fit() {
    const [wide, high] = [canvas.clientWidth, canvas.clientHeight];
    renderer.setSize(wide, high, false);
    camera.aspect = wide / Math.max(high, 1);
    camera.updateProjectionMatrix();
    stale = true;
  }

  function play(wanted) {
    playing = wanted;
    if (playing && time >= last) time = first;
    before = null;
    element("play").textContent = playing ? "Pause" : "Play";
    element("play").setAttribute("aria-pressed", String(playing));
    stale = true;
  }

  function frame(now) {
    if (playing) {
      if (before !== null) time = Math.min(time + (now - before) * 1e-3 * Number(element("speed").value), last);
      before = now;
      stale = true;
      if (time >= last) play(false);
    }
    if (stale) {
      stale = false;
      pose();
      if (element("follow").checked) follow();
      controls.update();
      renderer.render(stage, camera);
    }
    requestAnimationFrame(frame);
  }

  const slider = element("time");
  [slider.min, slider.max] = [first, last];
  slider.addEventListener("input", () => { play(false); time = Number(slider.value); });
  for (const speed of run.speeds) element("speed").add(new Option(`${speed}×`, speed, speed === run.speed, speed === run.speed));
  element("play").addEventListener("click", () => play(!playing));
  element("home").addEventListener("click", home);
  controls.addEventListener("change", () => { stale = true; });
  element("follow").addEventListener("change", () => { stale = true; });
  document.addEventListener("keydown", (event) => {
    if (event.key === " " && event.target === document.body) { event.preventDefault(); play(!playing); }
  });
  new ResizeObserver(fit).observe(canvas);
  fit();
  pose();
  home();
  requestAnimationFrame(frame);
}

try {
  start();
} catch (error) {
  element("failure").textContent = `This page needs WebGL: ${error.message}`;
  element("failure").hidden = false;
}
