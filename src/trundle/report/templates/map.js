// Draws the class map of a report on a canvas, and says what is known at the place pointed at.
(function () {
  "use strict";
  var data = JSON.parse(document.getElementById("map-data").textContent);
  var canvas = document.getElementById("map-plot"), pen = canvas.getContext("2d");
  var choice = document.getElementById("map-choice"), reading = document.getElementById("map-reading");
  var said = reading.textContent, at = null, box = null;

  function view() { return data.views[choice ? Number(choice.value) : data.views.length - 1]; }

  // What is shown of the plan [m]: everything that has a line or a place.
  function range(v) {
    var xs = v.x.slice(), ys = v.y.slice(), plan = data.plans[v.plan];
    ["rings", "beams", "walls"].forEach(function (kind) {
      plan[kind].forEach(function (line) { line.forEach(function (p) { xs.push(p[0]); ys.push(p[1]); }); });
    });
    return [Math.min.apply(0, xs), Math.max.apply(0, xs), Math.min.apply(0, ys), Math.max.apply(0, ys)];
  }

  function layout(v) {
    var r = range(v), dx = Math.max(r[1] - r[0], 1), dy = Math.max(r[3] - r[2], 1);
    var pad = 34, width = canvas.parentNode.clientWidth || 600;
    var scale = Math.min((width - 2 * pad) / dx, (Math.min(460, Math.max(260, width)) - 2 * pad) / dy);
    var height = scale * dy + 2 * pad, left = (width - scale * dx) / 2;
    return {
      width: width, height: height, scale: scale, range: r, named: [],
      x: function (x) { return left + scale * (x - r[0]); },
      y: function (y) { return height - pad - scale * (y - r[2]); },
      back: function (px, py) { return [r[0] + (px - left) / scale, r[2] + (height - pad - py) / scale]; }
    };
  }

  function interval(list, value) {
    if (list.length < 2) { return 0; }
    var i = 0;
    while (i < list.length - 2 && list[i + 1] < value) { i += 1; }
    return i;
  }

  function nearest(list, value) {
    var best = 0;
    list.forEach(function (x, i) { if (Math.abs(x - value) < Math.abs(list[best] - value)) { best = i; } });
    return best;
  }

  // Half a step beyond the outermost places belongs to them, and no more.
  function reach(list, value) {
    var n = list.length, a = n > 1 ? (list[1] - list[0]) / 2 : 1e9, b = n > 1 ? (list[n - 1] - list[n - 2]) / 2 : 1e9;
    return value >= list[0] - a - 1e-9 && value <= list[n - 1] + b + 1e-9;
  }

  // The rank between four places, by what their margins are there; that of the nearest where one is unknown.
  function rank(v, fields, x, y) {
    if (!reach(v.x, x) || !reach(v.y, y)) { return null; }
    var own = v.ranks[nearest(v.y, y)][nearest(v.x, x)];
    if (own === null || own === 0 || v.x.length < 2 || v.y.length < 2) { return own; }
    var i = interval(v.y, y), j = interval(v.x, x), found = null;
    var s = Math.min(1, Math.max(0, (x - v.x[j]) / (v.x[j + 1] - v.x[j])));
    var t = Math.min(1, Math.max(0, (y - v.y[i]) / (v.y[i + 1] - v.y[i])));
    for (var k = 0; k < fields.length; k += 1) {
      var f = fields[k].rows, a = f[i][j], b = f[i][j + 1], c = f[i + 1][j], d = f[i + 1][j + 1];
      if (a === null || b === null || c === null || d === null) { return own; }
      var m = (1 - t) * ((1 - s) * a + s * b) + t * ((1 - s) * c + s * d);
      if (found === null) { found = m < 0 ? 1 : 0; }
      if (m >= 0 && fields[k].complete) { found = fields[k].rank; }
    }
    return found === null ? own : found;
  }

  function known(v) {
    return v.fields.map(function (rows, k) { return { rows: rows, rank: k + 2, complete: v.complete[k] }; })
      .filter(function (f) { return f.rows.some(function (row) { return row.some(function (m) { return m !== null; }); }); });
  }

  function paint(v, l) {
    var fields = known(v), step = 2, r = l.range;
    for (var py = Math.floor(l.y(r[3])); py < l.y(r[2]); py += step) {
      for (var px = Math.floor(l.x(r[0])); px < l.x(r[1]); px += step) {
        var p = l.back(px + step / 2, py + step / 2), found = rank(v, fields, p[0], p[1]);
        if (found === null) { continue; }
        pen.fillStyle = data.colours[found];
        pen.fillRect(px, py, step, step);
      }
    }
  }

  function trace(l, line, closed) {
    pen.beginPath();
    line.forEach(function (p, i) { pen[i ? "lineTo" : "moveTo"](l.x(p[0]), l.y(p[1])); });
    if (closed) { pen.closePath(); }
  }

  function stroke(l, line, colour, width, closed, dash) {
    pen.setLineDash(dash || []);
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    trace(l, line, closed);
    pen.stroke();
    pen.setLineDash([]);
  }

  function building(v, l) {
    var plan = data.plans[v.plan], r = l.range;
    plan.beams.forEach(function (line) { stroke(l, line, "rgba(60,60,60,.35)", 1); });
    plan.rings.forEach(function (line) { stroke(l, line, "#222", 1.4, true); });
    plan.walls.forEach(function (line) { stroke(l, line, "#222", 3); });
    plan.columns.forEach(function (line) { trace(l, line, true); pen.fillStyle = "#222"; pen.fill(); });
    pen.fillStyle = "#444";
    pen.font = "11px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    var taken = {};
    plan.grid.forEach(function (g) {
      var px = g[1] === 0 ? l.x(g[2]) : l.x(r[0]) - 20, py = g[1] === 0 ? l.y(r[3]) - 20 : l.y(g[2]);
      var slot = g[1] + ":" + Math.round((g[1] === 0 ? px : py) / 17);
      if (taken[slot]) { return; }
      taken[slot] = true;
      pen.beginPath();
      pen.arc(px, py, 8, 0, 2 * Math.PI);
      pen.strokeStyle = "#888";
      pen.lineWidth = 1;
      pen.stroke();
      pen.fillText(g[0].slice(0, 3), px, py);
    });
    [0, 1].forEach(function (axis) {
      var places = plan.grid.filter(function (g) { return g[1] === axis; }).map(function (g) { return g[2]; });
      places.sort(function (a, b) { return a - b; });
      places.slice(1).forEach(function (b, i) {
        var middle = (places[i] + b) / 2, apart = b - places[i];
        if (apart * l.scale < 46) { return; }
        pen.save();
        pen.translate(axis === 0 ? l.x(middle) : l.x(r[0]) - 14, axis === 0 ? l.y(r[3]) - 12 : l.y(middle));
        if (axis) { pen.rotate(-Math.PI / 2); }
        pen.fillText(Number(apart.toFixed(3)) + " m", 0, 0);
        pen.restore();
      });
    });
    if (plan.north !== null) {
      var a = plan.north * Math.PI / 180, x = l.width - 20, y = 22;
      pen.beginPath();
      pen.moveTo(x + 12 * Math.sin(a), y + 12 * Math.cos(a));
      pen.lineTo(x - 12 * Math.sin(a), y - 12 * Math.cos(a));
      pen.strokeStyle = "#222";
      pen.lineWidth = 1.5;
      pen.stroke();
      pen.fillText("N", x - 18 * Math.sin(a), y - 18 * Math.cos(a));
    }
    pen.textAlign = "left";
    pen.fillText(l.range[0].toFixed(0) + " to " + l.range[1].toFixed(0) + " m", l.x(r[0]), l.height - 14);
    pen.save();
    pen.translate(l.x(r[1]) + 14, l.y(r[2]));
    pen.rotate(-Math.PI / 2);
    pen.fillText(l.range[2].toFixed(0) + " to " + l.range[3].toFixed(0) + " m", 0, 0);
    pen.restore();
  }

  function label(text, px, py, l) {
    pen.font = "600 12px system-ui, sans-serif";
    var w = pen.measureText(text).width, x = Math.min(Math.max(px + 8, 2), l.width - w - 4);
    // What would cover an earlier name is left out: the list beside the map has all.
    if (l.named.some(function (n) { return x < n[0] + n[2] && x + w > n[0] && Math.abs(py - n[1]) < 15; })) { return; }
    l.named.push([x, py, w + 6]);
    pen.fillStyle = "rgba(255,255,255,.85)";
    pen.fillRect(x - 2, py - 17, w + 4, 15);
    pen.fillStyle = "#000";
    pen.textAlign = "left";
    pen.textBaseline = "middle";
    pen.fillText(text, x, py - 9);
  }

  function cross(px, py, colour) {
    [["#fff", 5], [colour, 2.5]].forEach(function (look) {
      pen.strokeStyle = look[0];
      pen.lineWidth = look[1];
      pen.beginPath();
      pen.moveTo(px - 5, py - 5); pen.lineTo(px + 5, py + 5);
      pen.moveTo(px - 5, py + 5); pen.lineTo(px + 5, py - 5);
      pen.stroke();
    });
  }

  function draw() {
    var v = view(), l = layout(v), ratio = window.devicePixelRatio || 1;
    canvas.width = Math.round(l.width * ratio);
    canvas.height = Math.round(l.height * ratio);
    canvas.style.width = l.width + "px";
    canvas.style.height = l.height + "px";
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    paint(v, l);
    building(v, l);
    data.routes.forEach(function (route) {
      if (v.routes.indexOf(route.name) < 0) { return; }
      var line = route.x.map(function (x, i) { return [x, route.y[i]]; });
      stroke(l, line, "#fff", 4);
      stroke(l, line, "#000", 2, false, [7, 5]);
      var middle = line[Math.floor((line.length - 1) / 2)], next = line[Math.floor((line.length - 1) / 2) + 1] || middle;
      label(route.name, l.x((middle[0] + next[0]) / 2) - 40, l.y((middle[1] + next[1]) / 2), l);
    });
    if (v.worst) {
      var wx = l.x(v.worst.x), wy = l.y(v.worst.y);
      [["#fff", 5], ["#c00", 2.5]].forEach(function (look) {
        pen.beginPath(); pen.arc(wx, wy, 7, 0, 2 * Math.PI);
        pen.strokeStyle = look[0]; pen.lineWidth = look[1]; pen.stroke();
      });
      label("worst: " + v.worst.margin + " of " + data.criterion, wx, wy + 26, l);
    }
    data.points.forEach(function (p) {
      if (v.points.indexOf(p.name) < 0) { return; }
      cross(l.x(p.x), l.y(p.y), "#000");
      label(p.name, l.x(p.x), l.y(p.y), l);
    });
    if (at) {
      pen.strokeStyle = "#c00";
      pen.lineWidth = 1.5;
      pen.strokeRect(l.x(v.x[at[1]]) - 6, l.y(v.y[at[0]]) - 6, 12, 12);
    }
    box = l;
  }

  function text(v, i, j) {
    if (v.ranks[i][j] === null) { return "no floor here"; }
    var r = v.readings.map(function (rows) { return rows[i][j]; }), parts = [data.names[v.ranks[i][j]]];
    if (r[0] !== null) {
      parts.push("margin to " + data.criterion + " " + r[0] + (r[1] === null ? "" : " at " + r[1] + " Hz"));
      parts.push(r[2] + " % of the runs above it");
    }
    data.levels.forEach(function (l, k) { if (r[3 + k] !== null) { parts.push(l[0] + " " + r[3 + k] + " " + l[1]); } });
    return "x " + v.x[j] + " m, y " + v.y[i] + " m: " + parts.join("; ");
  }

  function tell() {
    reading.textContent = at ? text(view(), at[0], at[1]) : said;
    draw();
  }

  canvas.addEventListener("pointermove", function (event) {
    var v = view(), p = box.back(event.offsetX, event.offsetY);
    at = [nearest(v.y, p[1]), nearest(v.x, p[0])];
    tell();
  });
  canvas.addEventListener("pointerleave", function () { at = null; tell(); });
  canvas.addEventListener("keydown", function (event) {
    var move = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [1, 0], ArrowDown: [-1, 0] }[event.key], v = view();
    if (!move) { return; }
    event.preventDefault();
    at = at || [0, 0];
    at = [Math.min(Math.max(at[0] + move[0], 0), v.y.length - 1), Math.min(Math.max(at[1] + move[1], 0), v.x.length - 1)];
    tell();
  });
  if (choice) { choice.addEventListener("change", function () { at = null; tell(); }); }
  window.addEventListener("resize", draw);
  draw();
}());
