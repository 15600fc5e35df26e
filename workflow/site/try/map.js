// The improved system: two hierarchical maps, by (1) and (6) to (9), and the schedule of section 6,
// as in recalib.learners.hierarchical. Both maps have cells at the same centres, so one array holds
// the rows of both.

const SHORTEST_MOVE = 1e-6, DIMENSIONS = 3;
const OUTPUTS = { position: [0, 1, 2], orientation: [3, 4, 5] };

class ImprovedMap {
  constructor({ supernet, subnet }, schedule) {
    this.schedule = schedule;
    [this.supernet, this.subnet] = [supernet, subnet].map(grid);
    this.theta = this.supernet.flatMap(w_k => this.subnet.map(w_kl => [...w_k, ...w_kl]));
    this.centres = this.theta.map(centre => [...centre]);
    this.jacobians = this.theta.map(() => UNIT.map(row => [...row]));
  }

  winner(desired) {
    return [nearest(desired.slice(0, 3), this.supernet), nearest(desired.slice(3), this.subnet)];
  }

  command(desired) {
    const [k, l] = this.winner(desired), cell = k * this.subnet.length + l;
    return plus(this.theta[cell], times(this.jacobians[cell], minus(desired, this.centres[cell])));
  }

  // One iteration. execute: from a command to { achieved, executed }; fraction of the training
  learn(desired, execute, fraction) {
    const [k, l] = this.winner(desired), jacobian = this.jacobians[k * this.subnet.length + l];
    const command = this.command(desired), first = execute(command);
    const correction = times(jacobian, minus(desired, first.achieved));
    const second = execute(plus(command, correction));
    if (!first.executed) return;
    const moved = minus(second.achieved, first.achieved), length = dot(moved, moved);
    const far = second.executed && length > SHORTEST_MOVE ** 2;
    const unexplained = minus(correction, times(jacobian, moved));
    for (const [name, outputs] of Object.entries(OUTPUTS)) {
      const [g_k, g_kl] = this.neighbourhood(k, l, name, fraction);
      const rate = linear(this.schedule.initial_rate, this.schedule.final_rate, fraction);
      this.theta.forEach((theta, cell) => {
        const near = g_k[Math.floor(cell / g_kl.length)] * g_kl[cell % g_kl.length] * rate;
        for (const output of outputs) {
          theta[output] += near * correction[output];
          const row = this.jacobians[cell][output], change = near * unexplained[output] / length;
          if (far) moved.forEach((number, axis) => { row[axis] += change * number; });
        }
      });
    }
  }

  // g_k and g_kl about the winner, for one of the two maps
  neighbourhood(k, l, name, fraction) {
    const { initial_width, final_widths } = this.schedule;
    return [[this.supernet, k], [this.subnet, l]].map(([centres, won], net) => {
      const width = equalVisits(initial_width, final_widths[name][net], fraction);
      return centres.map(centre => {
        const away = minus(centre, centres[won]);
        return Math.exp(-0.5 * dot(away, away) / width ** 2);
      });
    });
  }
}

const UNIT = [0, 1, 2, 3, 4, 5].map(row => [0, 1, 2, 3, 4, 5].map(column => +(row === column)));
const plus = (a, b) => a.map((number, i) => number + b[i]);
const minus = (a, b) => a.map((number, i) => number - b[i]);
const dot = (a, b) => a.reduce((sum, number, i) => sum + number * b[i], 0);
const times = (matrix, vector) => matrix.map(row => dot(row, vector));
const linear = (start, end, fraction) => start + (end - start) * fraction;

// Section 6: the same number of visits of a cell at every width.
function equalVisits(start, end, fraction) {
  const power = 1 - DIMENSIONS;
  return linear(start ** power, end ** power, fraction) ** (1 / power);
}

// The middles of equal boxes, with given numbers along three coordinates.
function grid(shape) {
  const middles = shape.map(n => Array.from({ length: n }, (_, i) => (2 * i + 1) / n - 1));
  const longer = (points, along) => points.flatMap(point => along.map(x => [...point, x]));
  return middles.reduce(longer, [[]]);
}

function nearest(point, centres) {
  const far = centres.map(centre => dot(centre, centre) - 2 * dot(point, centre));
  return far.indexOf(Math.min(...far));
}
