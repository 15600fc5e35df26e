// The study's training, and an identification, on an arm with arbitrary damage.

const MOVES = 3; // for identification: 18 measured numbers for ten parameters
const STEP = 1e-6; // m, rad: for derivatives

class Experiment {
  constructor(study) {
    this.study = study;
    this.controller = new Controller(study.robot);
    // the controller does not depend on the damage, so each pose is solved only once
    [this.desired, this.tests] = [study.desired, study.tests].map(poses => poses.map(u => ({
      u, pose: this.controller.workspace.toPose(u), angles: this.controller.angles(u),
    })));
  }

  plant(damage) {
    return new Plant(this.controller, this.study.robot.links, damage);
  }

  // Measurements of an arm with this damage, before learning and at intervals of iterations.
  *train(damage) {
    const { iterations, every, schedule } = this.study;
    const plant = this.plant(damage), map = new ImprovedMap(this.study, schedule);
    const command = ({ u, angles }) => this.controller.angles(map.command(u), angles);
    const execute = near => sent => {
      const angles = this.controller.angles(sent, near);
      const achieved = this.controller.workspace.toCoordinates(plant.achieve(angles));
      return { achieved, executed: angles !== null };
    };
    for (const [iteration, { u, angles }] of this.desired.entries()) {
      if (iteration % every === 0) yield this.measure(plant, command);
      map.learn(u, execute(angles), iteration / iterations);
    }
    yield this.measure(plant, command);
  }

  // Mean errors over the test poses, and the joint angles that the controller chose.
  measure(plant, correct) {
    const angles = this.tests.map(correct);
    const each = this.tests.map(({ pose }, test) => errors(plant.achieve(angles[test]), pose));
    const [position, orientation] = [0, 1].map(which =>
      each.reduce((sum, both) => sum + both[which], 0) / each.length);
    return { position, orientation, angles };
  }

  // The damage, identified from a few uncorrected moves by the Gauss-Newton method.
  identify(damage) {
    const moves = this.desired.slice(0, MOVES);
    const achieved = guess => moves.flatMap(({ angles }) =>
      this.controller.workspace.toCoordinates(this.plant(guess).achieve(angles)));
    const measured = achieved(damage);
    let guess = damage.map(() => 0), change;
    do {
      const predicted = achieved(guess), residual = minus(measured, predicted);
      const columns = guess.map((_, which) => {
        const shifted = guess.map((number, index) => number + (index === which ? STEP : 0));
        return minus(achieved(shifted), predicted).map(number => number / STEP);
      });
      change = solve(columns.map(column => times(columns, column)), times(columns, residual));
      guess = plus(guess, change);
    } while (largest(change) > STEP); // convergence is quadratic: the next step is negligible
    return guess;
  }

  // Measurements with commands from the identified arm.
  identified(damage) {
    const known = this.plant(this.identify(damage));
    return this.measure(this.plant(damage), ({ pose, angles }) => known.anglesFor(pose, angles));
  }
}
