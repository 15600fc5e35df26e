// The study's training, and an identification, on an arm with any damage.

const MOVES = 3; // to identify from: 18 numbers for ten
const LITTLE = 1e-6; // m, rad: for derivatives

class Experiment {
  constructor(study) {
    this.study = study;
    this.controller = new Controller(study.robot);
    // no damage changes what the controller does: each pose is solved once
    [this.desired, this.tests] = [study.desired, study.tests].map(poses => poses.map(u => ({
      u, pose: this.controller.workspace.toPose(u), angles: this.controller.angles(u),
    })));
  }

  plant(damage) {
    return new Plant(this.controller, this.study.robot.links, damage);
  }

  // What is measured of such an arm, before learning and after every so many iterations.
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

  // Mean errors over the test poses, and the joint angles that the controller was led to.
  measure(plant, correct) {
    const angles = this.tests.map(correct);
    const each = this.tests.map(({ pose }, test) => errors(plant.achieve(angles[test]), pose));
    const [position, orientation] = [0, 1].map(which =>
      each.reduce((sum, both) => sum + both[which], 0) / each.length);
    return { position, orientation, angles };
  }

  // The damage, found from a few uncorrected moves by Gauss and Newton's method.
  identify(damage) {
    const moves = this.desired.slice(0, MOVES);
    const achieved = guess => moves.flatMap(({ angles }) =>
      this.controller.workspace.toCoordinates(this.plant(guess).achieve(angles)));
    const measured = achieved(damage);
    let guess = damage.map(() => 0), change;
    do {
      const predicted = achieved(guess), residual = minus(measured, predicted);
      const columns = guess.map((_, which) => {
        const beside = guess.map((number, index) => number + (index === which ? LITTLE : 0));
        return minus(achieved(beside), predicted).map(number => number / LITTLE);
      });
      change = solve(columns.map(column => times(columns, column)), times(columns, residual));
      guess = plus(guess, change);
    } while (largest(change) > LITTLE); // the next one would be its square
    return guess;
  }

  // What is measured once the identified arm says which joint angles a pose needs.
  identified(damage) {
    const known = this.plant(this.identify(damage));
    return this.measure(this.plant(damage), ({ pose, angles }) => known.anglesFor(pose, angles));
  }
}
