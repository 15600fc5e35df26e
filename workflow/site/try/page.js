// The page: sliders, two views of the arm, and its errors during learning.

const VIEWS = { side: [0, 2, "-14 -80 128 86"], above: [0, 1, "-14 -66 128 86"] }; // axes; cm
const SHOWN = 12; // poses
const SLIDERS = { links: [0, 5, "cm", 100], joints: [-6, 6, "°", 180 / Math.PI] };
const ERRORS = { position: "cm", orientation: "°" };
const TICKS = [0, 50, 100, 150, 200];
const PAUSE = 50; // ms between displayed measurements

const find = selector => document.querySelector(`#try ${selector}`);
const withUnit = (number, unit) => `${number}${unit === "°" ? "" : " "}${unit}`;
const named = name => name.replace(/_(link|joint)$/, "").replaceAll("_", " ");

function drawn(parent, kind, attributes) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", kind);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return parent.appendChild(element);
}

class Page {
  constructor(study) {
    this.experiment = new Experiment(study);
    this.study = study;
    this.pose = 0;
    this.inputs = ["links", "joints"].flatMap(part => study.robot[part].map(entry =>
      this.slider(part, part === "links" ? entry[0] : entry)));
    this.time = find("[name=iteration]");
    this.time.max = study.iterations / study.every;
    this.time.addEventListener("input", () => { this.stop(); this.show(+this.time.value); });
    find(".paper").addEventListener("click", () => this.set(study.damage));
    find(".intact").addEventListener("click", () => this.set(study.damage.map(() => 0)));
    find(".learn").addEventListener("click", () => this.playing ? this.stop() : this.play());
    find(".next").addEventListener("click", () => {
      this.pose = (this.pose + 1) % SHOWN;
      this.show(+this.time.value);
    });
    this.set(study.damage);
  }

  slider(part, name) {
    const [min, max, unit, factor] = SLIDERS[part], row = document.createElement("div");
    row.innerHTML = `<label for="${name}">${named(name)}</label><output for="${name}"></output>
      <input type="range" id="${name}" min="${min}" max="${max}" step="0.5">`;
    const [, output, input] = find(`.${part}`).appendChild(row).children;
    const say = () => { output.value = input.ariaValueText = withUnit(+input.value, unit); };
    input.addEventListener("input", () => { say(); this.damage(); });
    return {
      get: () => input.value / factor,
      set(number) {
        input.value = number * factor;
        say();
      },
    };
  }

  set(damage) {
    this.inputs.forEach((input, index) => input.set(damage[index]));
    this.damage();
  }

  // The sliders were moved: restart learning for the new damage.
  damage() {
    this.now = this.inputs.map(input => input.get());
    this.plant = this.experiment.plant(this.now);
    this.training = this.experiment.train(this.now);
    this.history = [];
    this.identified = this.experiment.identified(this.now);
    this.show(0);
    this.stop();
  }

  play() {
    find(".learn").textContent = "Stop";
    const reduced = matchMedia("(prefers-reduced-motion: reduce)").matches;
    let step = +this.time.value < +this.time.max ? +this.time.value : 0;
    const next = () => {
      step = reduced ? +this.time.max : step + 1;
      this.show(step);
      if (step < this.time.max) this.playing = setTimeout(next, PAUSE);
      else this.stop();
    };
    this.playing = setTimeout(next);
  }

  stop() {
    clearTimeout(this.playing);
    this.playing = null;
    find(".learn").textContent = `Let it learn: ${this.study.iterations} iterations`;
    const { position, orientation } = this.history[+this.time.value];
    const iteration = this.time.value * this.study.every;
    find("[role=status]").textContent = `After ${iteration} iterations the tool is off by`
      + ` ${position.toFixed(2)} cm and ${orientation.toFixed(2)}° on average.`;
  }

  // Show the arm and its errors at a measurement; first learn up to it, if necessary.
  show(step) {
    while (this.history.length <= step) this.history.push(this.training.next().value);
    this.time.value = step;
    const iteration = step * this.study.every, measured = this.history[step];
    const words = `${iteration} iterations, ${2 * iteration} moves`;
    this.time.ariaValueText = find(".iteration").value = words;
    this.fill("before", this.history[0], 0);
    this.fill("map", measured, 2 * iteration);
    this.fill("identified", this.identified, MOVES);
    for (const view of Object.keys(VIEWS)) this.drawArm(view, measured.angles);
    for (const error of Object.keys(ERRORS)) this.drawErrors(error, step);
  }

  fill(row, measured, moves) {
    const cells = find(`tr.${row}`).cells;
    Object.entries(ERRORS).forEach(([error, unit], index) => {
      cells[index + 1].textContent = withUnit(measured[error].toFixed(2), unit);
    });
    cells[3].textContent = moves;
  }

  drawArm(view, angles) {
    const { controller, tests } = this.experiment;
    const [right, up, box] = VIEWS[view], svg = find(`svg.${view}`);
    svg.setAttribute("viewBox", box);
    svg.replaceChildren();
    const at = point => [100 * point[right], -100 * point[up]];
    const tool = pose => at([pose[3], pose[7], pose[11]]);
    const line = (kind, [x1, y1], [x2, y2]) =>
      drawn(svg, "line", { class: kind, x1, y1, x2, y2 });
    const disc = (kind, [cx, cy], r) => drawn(svg, "circle", { class: kind, cx, cy, r });
    const skeleton = ({ origins, pose }) => [[0, 0], ...origins.map(at), tool(pose)];
    const believed = angles[this.pose] ?? controller.home;
    const points = skeleton(controller.arm.stand(believed));
    const real = skeleton(this.plant.arm.stand(this.plant.standing(believed)));
    const short = this.study.robot.links.filter((_, link) => this.now[link]).map(([, end]) => end);
    const kind = damaged => (damaged ? "damaged" : "real");
    real.slice(1).forEach((end, part) => line(kind(short.includes(part)), real[part], end));
    real.slice(1, -1).forEach((origin, joint) => disc(kind(this.plant.offsets[joint]), origin, 2.6));
    drawn(svg, "polyline", { class: "believed", points: points.join(" ") });
    tests.slice(0, SHOWN).forEach(({ pose }, index) => {
      const missed = tool(this.plant.achieve(angles[index]));
      const here = index === this.pose ? " here" : "";
      line("missed", tool(pose), missed);
      disc("desired" + here, tool(pose), 2);
      disc("missed" + here, missed, 1.1);
    });
  }

  drawErrors(error, step) {
    const svg = find(`svg.${error}`), most = Math.max(1, this.history[0][error] * 1.15);
    const across = iteration => 24 + 1.3 * iteration, down = value => 112 - 98 * value / most;
    svg.replaceChildren();
    const text = (x, y, words, anchor) => {
      drawn(svg, "text", { x, y, "text-anchor": anchor }).textContent = words;
    };
    const every = [0.5, 1, 2, 5, 10].find(size => most / size <= 5);
    for (let value = 0; value < most; value += every) {
      drawn(svg, "path", { class: "grid", d: `M${across(0)} ${down(value)}H${across(200)}` });
      text(across(0) - 5, down(value) + 3, value, "end");
    }
    TICKS.forEach(tick => text(across(tick), 124, tick, "middle"));
    const path = (kind, points) =>
      drawn(svg, "polyline", { class: kind, points: points.join(" ") });
    const measured = this.history.map((errors, index) =>
      [across(index * this.study.every), down(errors[error])]);
    const left = down(this.identified[error]);
    path("identified", [measured[0], [across(MOVES / 2), left], [across(200), left]]);
    path("map", measured.slice(0, step + 1));
    drawn(svg, "circle", { class: "map", cx: measured[step][0], cy: measured[step][1], r: 3.5 });
  }
}

new Page(STUDY);
