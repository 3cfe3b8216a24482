// The page of a session: it draws what it is told, and says what is done to it. It knows no server.
// `scene` comes once, `frame` for every moment; a frozen file hands the same from what it holds.

const INK = "#22252a", SOFT = "#8a9099", LINE = "#d5d8dc", BLUE = "#1f6fb4", RED = "#c8452d", GREEN = "#2c8c52";
const LAYERS = {
  odours: "odour contours", mosaic: "all place fields", field: "one place field", charts: "charts",
  metric: "metric map", roadmap: "roadmap", trail: "trail",
};
const KEYS = {
  ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, 1], ArrowRight: [0, -1],
  w: [1, 0], s: [-1, 0], a: [0, 1], d: [0, -1],
};
const KEPT = 240;

const unpacked = (text, Kind) => new Kind(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
const byHeading = (angle) => `oklch(0.72 0.12 ${((angle + Math.PI) * 180) / Math.PI})`;
const known = (pose) => pose && pose[0] !== null && pose[1] !== null;

function element(tag, parent, attributes = {}, text = "") {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.textContent = text;
  parent.append(made);
  return made;
}

// A copy of an image with another source, decoded; itself where it has that source already, or none is given.
async function decoded(image, source) {
  if (!source || image.src === source) return image;
  const made = image.cloneNode();
  made.src = source;
  // what cannot be decoded shows its words
  await made.decode().catch(() => {});
  return made;
}

function shownInstead(image, other, visible) {
  other.style.visibility = visible ? "visible" : "hidden";
  if (other !== image) image.replaceWith(other);
  return other;
}

// A canvas that is as fine as the screen, and tells when it has another size.
class Sheet {
  constructor(parent, ratio, label) {
    this.canvas = element("canvas", parent, { role: "img", "aria-label": label });
    this.pen = this.canvas.getContext("2d");
    this.ratio = ratio;
  }
  fit() {
    const width = this.canvas.parentElement.clientWidth, fine = window.devicePixelRatio || 1;
    const height = Math.round(width * this.ratio);
    const changed = this.width !== width || this.height !== height || this.fine !== fine;
    if (changed) {
      Object.assign(this, { width, height, fine });
      this.canvas.width = width * fine;
      this.canvas.height = height * fine;
      this.canvas.style.height = `${height}px`;
    }
    this.pen.setTransform(fine, 0, 0, fine, 0, 0);
    this.pen.clearRect(0, 0, width, height);
    return changed;
  }
  line(points, close = false) {
    this.pen.beginPath();
    points.forEach(([x, y], k) => (k ? this.pen.lineTo(x, y) : this.pen.moveTo(x, y)));
    if (close) this.pen.closePath();
  }
  disc(x, y, radius) {
    this.pen.beginPath();
    this.pen.arc(x, y, radius, 0, 2 * Math.PI);
  }
}

// How metres become pixels of a sheet.
class Ruler {
  constructor(bounds, sheet, margin = 0.15) {
    const [x0, y0, x1, y1] = bounds;
    this.scale = Math.min(sheet.width / (x1 - x0 + 2 * margin), sheet.height / (y1 - y0 + 2 * margin));
    this.left = x0 - (sheet.width / this.scale - (x1 - x0)) / 2;
    this.top = y1 + (sheet.height / this.scale - (y1 - y0)) / 2;
  }
  pixels([x, y]) { return [(x - this.left) * this.scale, (this.top - y) * this.scale]; }
  metres([x, y]) { return [x / this.scale + this.left, this.top - y / this.scale]; }
}

class Page {
  constructor(root, send) {
    Object.assign(this, { root, send, shown: new Set(["odours", "trail"]), cell: 0, tool: "stand", colour: "heading" });
    Object.assign(this, { errors: [], trail: [], way: [], keys: new Set(), yaw: 0.6, pitch: 0.5, acts: 0, sent: {} });
    this.stats = { frames: 0, rate: 0, latency: null, drawn: 0 };
    this.stamps = [];
    this.turn = Promise.resolve();
    this.build();
    this.listen();
    window.cogmap = this;
  }

  act(said) {
    this.acts += 1;
    this.sent[this.acts] = performance.now();
    this.send({ ...said, act: this.acts });
  }

  build() {
    this.root.classList.add("cogmap");
    const panel = (name, title, note = "") => {
      const made = element("section", this.root, { class: `panel ${name}` });
      const head = element("h2", made, {}, title);
      element("small", head, {}, note);
      return made;
    };
    const plan = panel("plan", "The room from above", "");
    this.note = plan.querySelector("small");
    this.plan = new Sheet(element("div", plan, { class: "sheet" }), 0.84, "the room from above, with the explorer");
    const chips = element("div", plan, { class: "chips" });
    for (const [name, label] of Object.entries(LAYERS)) {
      const chip = element("button", chips, { type: "button", "data-layer": name, "aria-pressed": this.shown.has(name) }, label);
      chip.onclick = () => {
        this.shown.has(name) ? this.shown.delete(name) : this.shown.add(name);
        chip.setAttribute("aria-pressed", this.shown.has(name));
        this.still = null;
        this.paint();
      };
    }
    this.pick = element("input", document.createElement("span"), { type: "number", min: 0, value: 0, title: "which place cell", "aria-label": "place cell" });
    chips.querySelector("[data-layer=field]").after(this.pick);
    this.pick.oninput = () => {
      this.cell = Math.max(0, Math.min(this.scene.fields.cells - 1, Number(this.pick.value) || 0));
      if (!this.shown.has("field")) chips.querySelector("[data-layer=field]").click();
      this.still = null;
      this.paint();
    };
    const eyes = panel("eyes", "What it sees, and what its map expects there");
    this.views = {};
    for (const [name, label] of [["seen", "seen"], ["dream", "dreamt at its own estimate"], ["surprise", "surprise: their difference, in units of what is usual"]]) {
      const figure = element("figure", eyes);
      this.views[name] = element("img", figure, { alt: label, draggable: "false" });
      element("figcaption", figure, {}, label);
    }
    this.word = element("p", eyes, { class: "word" });
    const cells = panel("cells", "Place cells", "each where it fires most, bright while it fires");
    this.mosaic = new Sheet(element("div", cells, { class: "sheet" }), 0.74, "rates of the place cells in the room");
    const ring = panel("heads", "Heading cells", "a ring");
    this.ring = new Sheet(element("div", ring, { class: "sheet" }), 0.9, "rates of the heading cells around a ring");
    const traces = panel("traces", "Decoded against true");
    this.trace = new Sheet(element("div", traces, { class: "sheet" }), 0.62, "errors of place and heading over time");
    const space = panel("space", "The view manifold", "drag to turn");
    this.cloud = new Sheet(element("div", space, { class: "sheet" }), 0.86, "the embedding in three dimensions");
    const colours = element("div", space, { class: "chips" });
    for (const name of ["heading", "place"]) {
      const chip = element("button", colours, { type: "button", "data-colour": name, "aria-pressed": name === "heading" }, `by ${name}`);
      chip.onclick = () => {
        this.colour = name;
        for (const other of colours.children) other.setAttribute("aria-pressed", other === chip);
        this.stars = null;
        this.paint();
      };
    }
    const near = panel("near", "Remembered, most alike");
    this.near = [0, 1, 2].map(() => {
      const figure = element("figure", near);
      return { image: element("img", figure, { alt: "a remembered view", draggable: "false" }), text: element("figcaption", figure) };
    });
    this.route = panel("route", "The way, dreamt before it is gone", "set a goal: choose “goal” or hold shift, and drag where it should look");
    this.strip = element("div", this.route, { class: "strip" });
  }

  listen() {
    const plan = this.plan.canvas;
    const at = (event) => {
      const box = plan.getBoundingClientRect();
      return this.ruler.metres([event.clientX - box.left, event.clientY - box.top]);
    };
    plan.onpointerdown = (event) => {
      if (!this.scene || this.scene.kind === "arm") return;
      plan.setPointerCapture(event.pointerId);
      document.activeElement?.blur();
      const place = at(event), tool = event.shiftKey ? "goal" : this.tool;
      this.drag = { tool, place, pixel: [event.clientX, event.clientY], heading: null };
      if (tool === "box") this.drag.box = this.boxAt(place);
      if (tool === "stand") this.act({ stand: place });
    };
    plan.onpointermove = (event) => {
      const drag = this.drag;
      if (!drag) return;
      const place = at(event), far = Math.hypot(event.clientX - drag.pixel[0], event.clientY - drag.pixel[1]);
      if (drag.tool === "box") drag.to = place;
      else if (far > 8) {
        drag.heading = Math.atan2(place[1] - drag.place[1], place[0] - drag.place[0]);
        const now = performance.now();
        if (drag.tool === "stand" && now - (drag.last || 0) > 40) {
          drag.last = now;
          this.act({ stand: drag.place, heading: drag.heading });
        }
      }
      this.paint();
    };
    plan.onpointerup = () => {
      const drag = this.drag;
      this.drag = null;
      if (!drag) return;
      if (drag.tool === "goal") this.act({ goal: drag.place, heading: drag.heading ?? (this.frame?.pose?.[2] || 0) });
      if (drag.tool === "stand" && drag.heading !== null) this.act({ stand: drag.place, heading: drag.heading });
      if (drag.tool === "box" && drag.box !== undefined && drag.to) {
        const box = this.boxes()[drag.box].outline;
        const middle = [0, 1].map((k) => (box[0][k] + box[2][k]) / 2 + drag.to[k] - drag.place[k]);
        this.act({ box: drag.box, place: middle });
      }
      this.paint();
    };
    const held = () => {
      const sum = [0, 0];
      for (const key of this.keys) KEYS[key].forEach((share, k) => (sum[k] += share));
      this.act({ drive: sum });
    };
    const key = (event) => (event.key.length === 1 ? event.key.toLowerCase() : event.key);
    const typing = (event) => ["INPUT", "SELECT", "TEXTAREA"].includes(event.target.tagName) || event.target.getAttribute?.("role") === "slider";
    document.addEventListener("keydown", (event) => {
      if (!(key(event) in KEYS) || typing(event) || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      if (!this.keys.has(key(event))) { this.keys.add(key(event)); held(); }
    });
    document.addEventListener("keyup", (event) => { if (this.keys.delete(key(event))) held(); });
    window.addEventListener("blur", () => { if (this.keys.size) { this.keys.clear(); held(); } });
    const cloud = this.cloud.canvas;
    cloud.onpointerdown = (event) => { cloud.setPointerCapture(event.pointerId); this.spin = [event.clientX, event.clientY]; };
    cloud.onpointermove = (event) => {
      if (!this.spin) return;
      this.yaw += (event.clientX - this.spin[0]) * 0.01;
      this.pitch = Math.max(-1.5, Math.min(1.5, this.pitch + (event.clientY - this.spin[1]) * 0.01));
      this.spin = [event.clientX, event.clientY];
      this.stars = null;
      this.paint();
    };
    cloud.onpointerup = () => (this.spin = null);
    new ResizeObserver(() => { this.still = this.stars = null; this.paint(); }).observe(this.root);
  }

  boxes() { return this.room.solids.filter((solid) => solid.box); }

  boxAt(place) {
    let nearest, least = 0.7;
    this.boxes().forEach(({ outline }, k) => {
      const away = Math.hypot(...[0, 1].map((i) => (outline[0][i] + outline[2][i]) / 2 - place[i]));
      if (away < least) [nearest, least] = [k, away];
    });
    return nearest;
  }

  setScene(scene) {
    this.scene = scene;
    this.room = scene.room;
    this.root.classList.toggle("arm", scene.kind === "arm");
    if (scene.kind === "arm") this.root.querySelector(".eyes h2").firstChild.textContent = "What its eye sees";
    const names = scene.embedding.colours || ["by heading", "by place"];
    this.root.querySelectorAll("[data-colour]").forEach((chip, k) => (chip.textContent = names[k]));
    this.note.textContent = scene.kind === "arm" ? "bend its joints with the sliders" : `${scene.room.name}: click to stand, drag to turn, arrows or WASD to drive`;
    if (scene.fields) {
      this.fields = unpacked(scene.fields.data, Uint8Array);
      this.pick.max = scene.fields.cells - 1;
    }
    this.points = unpacked(scene.embedding.points, Float32Array);
    this.looks = unpacked(scene.embedding.poses, Float32Array);
    const [x0, y0, x1, y1] = scene.room.bounds;
    this.plan.ratio = (y1 - y0 + 0.3) / (x1 - x0 + 0.3);
    this.mosaic.ratio = this.plan.ratio;
    this.still = this.stars = null;
    this.paint();
  }

  setRoom(room) { this.room = room || this.scene.room; this.still = null; this.paint(); }

  setTool(tool) { this.tool = tool; }

  addDreamt(views, from) {
    if (from === 0) this.strip.replaceChildren();
    for (const view of views) element("img", this.strip, { src: view, alt: "a dreamt view on the way", draggable: "false" });
  }

  // Moments are shown one after the other, as they came.
  setFrame(frame) {
    const turn = this.turn.then(() => this.show(frame));
    this.turn = turn.catch(() => {});
    return turn;
  }

  // All pictures are decoded beside the page before any is changed: what changes in one go is composed once.
  async show(frame) {
    const views = frame.near.map(({ view }) => view);
    const [pictures, near] = await Promise.all([
      Promise.all(Object.entries(this.views).map(async ([name, image]) => [name, await decoded(image, frame[name])])),
      Promise.all(this.near.map(({ image }, k) => decoded(image, views[k]))),
    ]);
    this.frame = frame;
    for (const [name, picture] of pictures) this.views[name] = shownInstead(this.views[name], picture, frame[name]);
    this.near.forEach((one, k) => {
      const { text } = one, view = frame.near[k];
      one.image = shownInstead(one.image, near[k], view);
      if (view?.joints) text.textContent = `joints ${view.joints.map((joint) => joint.toFixed(2)).join(", ")} rad`;
      else text.textContent = view ? `from ${view.pose[0].toFixed(2)}, ${view.pose[1].toFixed(2)} m, ${Math.round((view.pose[2] * 180) / Math.PI)}°` : "";
    });
    if (this.scene.kind === "arm") this.word.textContent = `coordinates ${frame.coordinates.map((value) => value.toFixed(2)).join(", ")}`;
    else this.feel(frame);
    if (frame.point) {
      const last = this.way.at(-1);
      if (last && Math.hypot(...last.map((v, k) => v - frame.point[k])) > 0.3) this.way = [];
      this.way.push(frame.point);
    }
    if (this.way.length > 60) this.way.shift();
    this.paint();
    const now = performance.now();
    this.stamps.push(now);
    while (this.stamps[0] < now - 1000) this.stamps.shift();
    this.stats.frames += 1;
    this.stats.rate = this.stamps.length;
    if (frame.act && this.sent[frame.act]) {
      this.stats.latency = now - this.sent[frame.act];
      for (const old of Object.keys(this.sent)) if (old <= frame.act) delete this.sent[old];
    }
  }

  // What an explorer knows of where it is, beside the truth.
  feel(frame) {
    if (!frame.route.length) this.strip.replaceChildren();
    const loud = frame.surprised === null ? "" : `most surprising patch ${frame.surprised.toFixed(1)} × usual`;
    const strange = frame.novelty !== null && frame.novelty > 4 ? ` · ${frame.novelty.toFixed(1)} × as unlike what it remembers as usual` : "";
    this.word.textContent = [frame.lights ? loud + strange : "in the dark: the nose tells place, nothing tells heading", this.scene.reason && `it does not dream: ${this.scene.reason}`].filter(Boolean).join(" · ");
    this.errors.push([frame.errors.m, frame.errors.rad]);
    if (this.errors.length > KEPT) this.errors.shift();
    if (known(frame.pose)) {
      const last = this.trail.at(-1), here = [frame.pose[0], frame.pose[1]];
      if (last && Math.hypot(last[0] - here[0], last[1] - here[1]) > 0.4) this.trail = [];
      this.trail.push(here);
    }
    if (this.trail.length > 4 * KEPT) this.trail.shift();
    this.rates = { place: unpacked(frame.place, Uint8Array), heading: unpacked(frame.heading, Uint8Array) };
  }

  paint() {
    if (!this.scene) return;
    this.paintPlan();
    this.paintCloud();
    if (this.scene.kind === "arm") return;
    this.paintMosaic();
    this.paintRing();
    this.paintTraces();
  }

  // What does not change from frame to frame is painted once.
  stillPlan() {
    const { plan, room, shown, scene } = this, sheet = { ...{ width: plan.width, height: plan.height } };
    const canvas = document.createElement("canvas");
    canvas.width = plan.canvas.width;
    canvas.height = plan.canvas.height;
    const pen = canvas.getContext("2d");
    pen.setTransform(plan.fine, 0, 0, plan.fine, 0, 0);
    this.ruler = new Ruler(room.bounds, sheet);
    const to = (point) => this.ruler.pixels(point);
    const trace = (points, close) => {
      pen.beginPath();
      points.forEach((point, k) => (k ? pen.lineTo(...to(point)) : pen.moveTo(...to(point))));
      if (close) pen.closePath();
    };
    pen.fillStyle = "#fbfbf9";
    for (const ring of room.platform) { trace(ring, true); pen.fill(); }
    if (scene.fields && (shown.has("mosaic") || shown.has("field"))) this.paintFields(pen);
    if (shown.has("odours")) for (const { colour, lines } of room.odours) {
      pen.strokeStyle = colour;
      pen.lineWidth = 1.2;
      for (const line of lines) { trace(line); pen.stroke(); }
    }
    const links = (ends, colour, width) => {
      pen.strokeStyle = colour;
      pen.lineWidth = width;
      pen.beginPath();
      for (const [a, b, c, d] of ends) { pen.moveTo(...to([a, b])); pen.lineTo(...to([c, d])); }
      pen.stroke();
    };
    if (shown.has("roadmap") && scene.roadmap) links(scene.roadmap, "rgba(44, 140, 82, .45)", 1);
    if (shown.has("metric") && scene.metric) links(scene.metric, "rgba(31, 111, 180, .75)", 1.2);
    if (shown.has("charts") && scene.charts) for (const [x, y, heading] of scene.charts) {
      const [px, py] = to([x, y]);
      pen.strokeStyle = byHeading(heading);
      pen.beginPath();
      pen.moveTo(px, py);
      pen.lineTo(px + 6 * Math.cos(heading), py - 6 * Math.sin(heading));
      pen.stroke();
    }
    pen.setLineDash([5, 4]);
    pen.strokeStyle = SOFT;
    pen.lineWidth = 1;
    for (const ring of room.platform) { trace(ring, true); pen.stroke(); }
    pen.setLineDash([]);
    for (const { outline, colour } of room.solids) {
      trace(outline, true);
      pen.fillStyle = colour;
      pen.fill();
      pen.strokeStyle = INK;
      pen.stroke();
    }
    for (const [colour, width] of [[INK, 7], [null, 5]]) for (const wall of room.walls) {
      trace(wall.ends);
      pen.strokeStyle = colour || wall.colour;
      pen.lineWidth = width;
      pen.stroke();
    }
    room.sources.forEach((source, k) => {
      const [x, y] = to(source);
      pen.fillStyle = room.odours[k].colour;
      pen.beginPath();
      pen.arc(x, y, 5, 0, 7);
      pen.fill();
      pen.strokeStyle = INK;
      pen.lineWidth = 1;
      pen.stroke();
    });
    return canvas;
  }

  paintFields(pen) {
    const { shape: [rows, columns], bounds: [x0, y0, x1, y1], cells } = this.scene.fields, size = rows * columns;
    const image = new ImageData(columns, rows);
    for (let bin = 0; bin < size; bin++) {
      let best = this.cell, rate = this.fields[best * size + bin];
      if (rate === 255) continue;
      if (!this.shown.has("field")) for (let cell = 0; cell < cells; cell++) {
        if (this.fields[cell * size + bin] > rate) [best, rate] = [cell, this.fields[cell * size + bin]];
      }
      const hue = this.shown.has("field") ? 210 : (best * 137.5) % 360, share = rate / 254;
      const [r, g, b] = [0, 8, 4].map((k) => { const m = (k + hue / 30) % 12; return 255 * (0.62 - 0.22 * Math.max(-1, Math.min(m - 3, 9 - m, 1))); });
      image.data.set([r, g, b, 220 * (this.shown.has("field") ? share : share * share)], 4 * ((rows - 1 - Math.floor(bin / columns)) * columns + (bin % columns)));
    }
    const small = document.createElement("canvas");
    [small.width, small.height] = [columns, rows];
    small.getContext("2d").putImageData(image, 0, 0);
    const [left, top] = this.ruler.pixels([x0, y1]), [right, bottom] = this.ruler.pixels([x1, y0]);
    pen.imageSmoothingEnabled = this.shown.has("field");
    pen.drawImage(small, left, top, right - left, bottom - top);
  }

  paintPlan() {
    const { plan, frame } = this;
    if (plan.fit() || !this.still) this.still = this.stillPlan();
    const pen = plan.pen, to = (point) => this.ruler.pixels(point);
    pen.drawImage(this.still, 0, 0, plan.width, plan.height);
    if (this.shown.has("trail")) {
      plan.line(this.trail.map(to));
      pen.strokeStyle = "rgba(34, 37, 42, .25)";
      pen.lineWidth = 1.5;
      pen.stroke();
    }
    if (frame?.links) {
      pen.lineCap = pen.lineJoin = "round";
      plan.line([frame.links[0][0], ...frame.links.map((link) => link[1])].map(to));
      pen.strokeStyle = RED;
      pen.lineWidth = 2 * this.scene.radius * this.ruler.scale;
      pen.stroke();
      for (const joint of [frame.links[0][0], ...frame.links.map((link) => link[1])]) {
        plan.disc(...to(joint), 0.35 * this.scene.radius * this.ruler.scale);
        pen.fillStyle = "white";
        pen.fill();
      }
    } else if (frame) {
      if (frame.route.length) {
        plan.line(frame.route.map(to));
        pen.strokeStyle = GREEN;
        pen.lineWidth = 2.5;
        pen.stroke();
      }
      if (known(frame.goal)) this.body(frame.goal, GREEN, true);
      if (known(frame.ghost)) this.body(frame.ghost, BLUE, true);
      if (known(frame.pose)) this.body(frame.pose, frame.touched ? "#e8912d" : RED, false);
    }
    const drag = this.drag;
    if (drag?.tool === "goal") this.body([...drag.place, drag.heading ?? 0], GREEN, true);
    if (drag?.tool === "box" && drag.box !== undefined && drag.to) {
      plan.line(this.boxes()[drag.box].outline.map((corner) => to(corner.map((v, k) => v + drag.to[k] - drag.place[k]))), true);
      pen.strokeStyle = RED;
      pen.stroke();
    }
  }

  body([x, y, heading], colour, hollow) {
    const { pen } = this.plan, [px, py] = this.ruler.pixels([x, y]), radius = this.scene.radius * this.ruler.scale;
    this.plan.disc(px, py, radius);
    pen.lineWidth = 2.5;
    pen.strokeStyle = colour;
    pen.fillStyle = colour;
    if (hollow) { pen.setLineDash([4, 3]); pen.stroke(); pen.setLineDash([]); } else pen.fill();
    if (heading === null) return;
    pen.strokeStyle = hollow ? colour : "white";
    pen.beginPath();
    pen.moveTo(px, py);
    pen.lineTo(px + radius * Math.cos(heading), py - radius * Math.sin(heading));
    pen.stroke();
  }

  paintMosaic() {
    const { mosaic, scene, rates, frame } = this;
    mosaic.fit();
    if (!rates || !scene.preferred) return;
    const pen = mosaic.pen, ruler = new Ruler(scene.fields.bounds, mosaic, 0.1);
    for (const ring of scene.room.platform) {
      mosaic.line(ring.map((point) => ruler.pixels(point)), true);
      pen.strokeStyle = LINE;
      pen.stroke();
    }
    scene.preferred.place.forEach((place, cell) => {
      const share = rates.place[cell] / 255;
      mosaic.disc(...ruler.pixels(place), 0.085 * ruler.scale);
      pen.fillStyle = `rgba(31, 111, 180, ${0.07 + 0.93 * share})`;
      pen.fill();
    });
    if (known(frame?.pose)) {
      mosaic.disc(...ruler.pixels(frame.pose), 4);
      pen.strokeStyle = RED;
      pen.lineWidth = 2;
      pen.stroke();
    }
  }

  paintRing() {
    const { ring, scene, rates, frame } = this;
    ring.fit();
    if (!rates || !scene.preferred) return;
    const pen = ring.pen, [x, y] = [ring.width / 2, ring.height / 2], inner = 0.26 * ring.width, long = 0.16 * ring.width;
    pen.lineCap = "round";
    scene.preferred.heading.forEach((angle, cell) => {
      const share = rates.heading[cell] / 255, [c, s] = [Math.cos(angle), -Math.sin(angle)];
      pen.strokeStyle = byHeading(angle);
      pen.globalAlpha = 0.25 + 0.75 * share;
      pen.lineWidth = 5;
      pen.beginPath();
      pen.moveTo(x + inner * c, y + inner * s);
      pen.lineTo(x + (inner + 2 + long * share) * c, y + (inner + 2 + long * share) * s);
      pen.stroke();
    });
    pen.globalAlpha = 1;
    for (const [pose, colour, dash] of [[frame.pose, RED, []], [frame.ghost, BLUE, [4, 3]]]) {
      if (!pose || pose[2] === null) continue;
      pen.strokeStyle = colour;
      pen.lineWidth = 2.5;
      pen.setLineDash(dash);
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(x + 0.85 * inner * Math.cos(pose[2]), y - 0.85 * inner * Math.sin(pose[2]));
      pen.stroke();
    }
    pen.setLineDash([]);
  }

  paintTraces() {
    const { trace, errors } = this;
    trace.fit();
    const pen = trace.pen, half = trace.height / 2;
    [["place", 100, "cm", BLUE, 5], ["heading", 180 / Math.PI, "°", RED, 3]].forEach(([name, unit, suffix, colour, least], row) => {
      const values = errors.map((pair) => (pair[row] === null ? null : pair[row] * unit));
      const top = Math.max(least, ...values.filter((v) => v !== null)), floor = (row + 1) * half - 4, high = half - 24;
      pen.strokeStyle = LINE;
      pen.lineWidth = 1;
      pen.strokeRect(0.5, floor - high, trace.width - 1, high);
      pen.beginPath();
      let down = false;
      values.forEach((value, k) => {
        if (value === null) { down = false; return; }
        const [x, y] = [(k / (KEPT - 1)) * trace.width, floor - (value / top) * high];
        down ? pen.lineTo(x, y) : pen.moveTo(x, y);
        down = true;
      });
      pen.strokeStyle = colour;
      pen.lineWidth = 1.5;
      pen.stroke();
      const last = values.at(-1);
      pen.fillStyle = INK;
      pen.font = "12px system-ui, sans-serif";
      pen.textAlign = "left";
      pen.fillText(`${name} off by ${last === null || last === undefined ? "—" : last.toFixed(2)} ${suffix}`, 2, floor - high - 6);
      pen.textAlign = "right";
      pen.fillStyle = SOFT;
      pen.fillText(`${top.toFixed(0)} ${suffix}`, trace.width - 4, floor - high + 13);
    });
  }

  project(x, y, z) {
    const [c, s, cp, sp] = [Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch)];
    const [u, v] = [c * x - s * y, s * x + c * y], size = 0.55 * Math.min(this.cloud.width, this.cloud.height);
    return [this.cloud.width / 2 + size * u, this.cloud.height / 2 - size * (cp * z - sp * v), cp * v + sp * z];
  }

  paintCloud() {
    const { cloud } = this;
    if (cloud.fit() || !this.stars) {
      this.stars = document.createElement("canvas");
      [this.stars.width, this.stars.height] = [cloud.canvas.width, cloud.canvas.height];
      const pen = this.stars.getContext("2d"), [x0, y0, x1, y1] = this.scene.room.bounds;
      pen.setTransform(cloud.fine, 0, 0, cloud.fine, 0, 0);
      const order = [];
      for (let k = 0; k < this.points.length / 3; k++) order.push([k, ...this.project(...this.points.subarray(3 * k, 3 * k + 3))]);
      order.sort((a, b) => b[3] - a[3]);
      for (const [k, x, y, depth] of order) {
        const [px, py, heading] = this.looks.subarray(3 * k, 3 * k + 3);
        const [u, v] = [(px - x0) / (x1 - x0), (py - y0) / (y1 - y0)];
        if (this.scene.kind === "arm") pen.fillStyle = byHeading(this.colour === "heading" ? heading : px);
        else pen.fillStyle = this.colour === "heading" ? byHeading(heading) : `rgb(${40 + 200 * u} ${60 + 150 * v} ${225 - 190 * u})`;
        pen.globalAlpha = 0.75 - 0.35 * Math.max(-1, Math.min(1, depth));
        pen.fillRect(x - 1.2, y - 1.2, 2.4, 2.4);
      }
    }
    const pen = cloud.pen;
    pen.drawImage(this.stars, 0, 0, cloud.width, cloud.height);
    const way = this.way.map((point) => this.project(...point));
    cloud.line(way);
    pen.strokeStyle = "rgba(34, 37, 42, .5)";
    pen.lineWidth = 1.5;
    pen.stroke();
    if (this.frame?.point && way.length) {
      cloud.disc(...way.at(-1).slice(0, 2), 6);
      pen.fillStyle = INK;
      pen.fill();
      pen.strokeStyle = "white";
      pen.lineWidth = 2;
      pen.stroke();
    }
  }
}

// In a frozen file what is done leads to the nearest pose that was sampled.
function thaw(root, frozen) {
  let here = [0, 0, 0];
  // views that several poses have in common are held once
  for (const frame of frozen.frames) for (const near of frame.near) near.view = frozen.held[near.view];
  const page = new Page(root, (said) => {
    if (said.goal || said.box !== undefined) return;
    const step = said.drive || [0, 0];
    here = said.stand ? [...said.stand, said.heading ?? here[2]]
      : [here[0] + 0.25 * step[0] * Math.cos(here[2]), here[1] + 0.25 * step[0] * Math.sin(here[2]), here[2] + (step[1] * Math.PI) / 4];
    show(said.act, step);
  });
  const show = (act, step = [0, 0]) => {
    const cost = ({ pose }) => Math.hypot(pose[0] - here[0], pose[1] - here[1]) + 0.35 * (1 - Math.cos(pose[2] - here[2]));
    const nearest = frozen.frames.reduce((best, frame) => (cost(frame) < cost(best) ? frame : best));
    if (!step[0] && !step[1]) here = [...nearest.pose];
    page.setFrame({ ...nearest, act });
  };
  root.classList.add("frozen");
  page.setScene(frozen.scene);
  page.note.textContent = `${frozen.scene.room.name}: click, drag, arrow keys; this file holds ${frozen.frames.length} poses`;
  here = [...frozen.frames[0].pose];
  show();
  return page;
}

// How NiceGUI holds it.
export default {
  template: "<div></div>",
  mounted() {
    this.page = new Page(this.$el, (said) => this.$emit("act", said));
    this.$emit("ready");
  },
  methods: {
    scene(scene) { this.page.setScene(scene); },
    room(room) { this.page.setRoom(room); },
    tool(tool) { this.page.setTool(tool); },
    dreamt(views, from) { this.page.addDreamt(views, from); },
    async frame(frame) { await this.page.setFrame(frame); this.$emit("drawn"); },
  },
};
