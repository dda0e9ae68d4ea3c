/* Adhesive contact of a sphere with memory: force by the history of its depth.
 *
 * Made by viscotack $version for: $of
 * Range: $range.
 * 19 of 20 simulated pull-off forces lie within a relative $force_band (slow to fastest edge), works
 * within $work_band, if ${name}_edge_speed stays below ${name}_fastest up to the pull-off.
 * In SI; depths are positive into the solid, forces in compression. C99 or C++, needs only math.h.
 * Every step is passive: the mean force times the change of depth is not below the change of
 * ${name}_storage. Copyright of this file: none (CC0).
 *
 *   ${name} it;
 *   ${name}_apart(&it, -1e-6);                  once, out of contact
 *   force = ${name}_step(&it, depth, dt, NULL);  at every step of time
 */
#ifndef ${guard}_H
#define ${guard}_H
#include <math.h>
#include <stddef.h>

enum { ${name}_cells = $cells, ${name}_modes = $modes, ${name}_rows = $rows };
static const double ${name}_node[$cells + 1] = {$node};
static const double ${name}_modulus[$modes] = {$modulus}, ${name}_time[$modes] = {$relaxation_time};
static const double ${name}_first[2] = {$first}, ${name}_per[2] = {$per};
static const double ${name}_edge_energy[2][$rows] = {$energy};
static const double ${name}_zone_time[2][$rows] = {$zone_time};
static const double ${name}_surface = $surface;
static const double ${name}_length = $length, ${name}_newton = $force_unit;
static const double ${name}_beta = $radius_unit, ${name}_pi = 3.14159265358979323846;

/* Depth, radius and its rate in units of ${name}_length and ${name}_beta; strains of the arms. */
typedef struct {
  double depth, radius, rate, way, front;
  double inner[$cells][$modes], outer[$cells][$modes];
} $name;

/* A contact that is apart and relaxed, at a depth [m] not above 0. */
static inline void ${name}_apart($name *it, double depth) {
  int i, m;
  it->depth = fmin(depth, 0.0) / ${name}_length;
  it->radius = it->rate = it->way = it->front = 0;
  for (i = 0; i < ${name}_cells; i++)
    for (m = 0; m < ${name}_modes; m++) it->inner[i][m] = it->outer[i][m] = 0;
}

static inline double ${name}_part(int i, double a, double b) {
  double low = fmax(${name}_node[i], a), high = fmin(${name}_node[i + 1], b);
  return fmax(high - low, 0.0);
}

static inline double ${name}_sum(const double *e) {
  double sum = 0;
  int m;
  for (m = 0; m < ${name}_modes; m++) sum += e[m] * ${name}_modulus[m];
  return sum;
}

static inline double ${name}_squares(const double *e) {
  double sum = 0;
  int m;
  for (m = 0; m < ${name}_modes; m++) sum += e[m] * e[m] * ${name}_modulus[m];
  return sum;
}

/* Twice the energy of a free annulus. */
static inline double ${name}_stored(const double *e) {
  double sum = ${name}_sum(e);
  return sum * sum + ${name}_squares(e);
}

/* Integral of (D - s^2)^2, and mean of s^2, between radii. */
static inline double ${name}_pressed(double D, double low, double high) {
  double a = high - low, b = (high + low) / 2, level = D - b * b;
  return a * (level * level + a * a * ((4 * b * b - 2 * level) / 12 + a * a / 80));
}
static inline double ${name}_square(double low, double high) {
  return (low * low + low * high + high * high) / 3;
}

/* The mean of e, of a length, and of another of a part that joins it. */
static inline void ${name}_mix(double *e, double length, const double *other, double part) {
  int m;
  for (m = 0; m < ${name}_modes; m++) e[m] += part / (length + part) * (other[m] - e[m]);
}

static inline double ${name}_row(const double rows[][$rows], int side, double rate) {
  double x = (log(fmax(rate, 1e-300)) - ${name}_first[side]) * ${name}_per[side];
  int i;
  x = fmin(fmax(x, 0.0), ${name}_rows - 1.0);
  i = (int)x < ${name}_rows - 2 ? (int)x : ${name}_rows - 2;
  return exp(rows[side][i] + (x - i) * (rows[side][i + 1] - rows[side][i]));
}

/* The cell of a radius; one that is a node belongs to the cell below it if inside. */
static inline int ${name}_cell(double r, int inside) {
  int low = 0, high = ${name}_cells;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (inside ? ${name}_node[middle] < r : ${name}_node[middle] <= r) low = middle;
    else high = middle;
  }
  return low;
}

/* Free annuli after a time, kept = 1/(1 + time over that of the arm); returns the rise. */
static inline double ${name}_recover(const double *e, const double *kept, double *out) {
  double surface = -${name}_sum(e), up = 0, arms = 0, rise;
  int m;
  for (m = 0; m < ${name}_modes; m++) {
    double arm = ${name}_modulus[m] * kept[m];
    up += (surface - e[m]) * arm, arms += arm;
  }
  rise = up / (1 + arms);
  for (m = 0; m < ${name}_modes; m++) out[m] = (rise - (surface - e[m])) * kept[m];
  return rise;
}

/* Force [N]. */
static inline double ${name}_force(const $name *it) {
  double a = it->radius, arms = 0;
  int i;
  for (i = 0; i < ${name}_cells && ${name}_node[i] < a; i++)
    arms += ${name}_part(i, 0, a) * ${name}_sum(it->inner[i]);
  return 2 * (a * (it->depth - a * a / 3) + arms) * ${name}_newton;
}

/* Contact radius [m]. */
static inline double ${name}_radius(const $name *it) { return it->radius * ${name}_beta; }

/* Speed of the edge in the last step [m/s], positive where it opens; where the bands end. */
static inline double ${name}_edge_speed(const $name *it) { return -it->rate * ${name}_beta; }
static const double ${name}_fastest = $fastest;

/* Stored energy [J], 0 if relaxed and apart. */
static inline double ${name}_storage(const $name *it) {
  double a = it->radius, sum = ${name}_pressed(it->depth, 0, a) - ${name}_surface * ${name}_pi * a * a;
  int i;
  for (i = 0; i < ${name}_cells; i++) {
    double inside = ${name}_part(i, 0, a), all = ${name}_node[i + 1] - ${name}_node[i];
    sum += inside * ${name}_squares(it->inner[i]) + (all - inside) * ${name}_stored(it->outer[i]);
  }
  return sum * ${name}_newton * ${name}_length;
}

static inline double ${name}_centre(const $name *it, int i) {
  return (${name}_node[i] + fmin(${name}_node[i + 1], it->front)) / 2;
}

/* Energy of the edge at a radius r above that at which it opens or closes. */
static inline double ${name}_excess(const $name *it, const double *level, int closes, double r,
                                    double dt, double *energy) {
  int i = ${name}_cell(r, !closes);
  double height = it->depth - r * r + level[i];
  if (!closes && i > 0) {
    double at = ${name}_centre(it, i), before = ${name}_centre(it, i - 1);
    height += (level[i] - level[i - 1]) / (at - before) * (r - at);
  }
  *energy = height < 0 ? height * height / (2 * ${name}_pi * r) : 0;
  if (!(dt > 0)) return 0;
  return closes ? ${name}_row(${name}_edge_energy, 1, (r - it->radius) / dt) - *energy
                : *energy - ${name}_row(${name}_edge_energy, 0, (it->radius - r) / dt);
}

/* Radius to which the edge goes in a step. */
static inline double ${name}_follow(const $name *it, const double *level, int closes, double dt) {
  double a = it->radius, near = a, far, width = $start, energy, least;
  double fastest = exp(${name}_first[0] + (${name}_rows - 1) / ${name}_per[0]);
  int k, ends;
  least = fmax(a - fastest * dt, 1e-12);
  far = closes ? a + width * fmax(a, $small) : fmax(a * (1 - width), least);
  for (k = 0; k < $doublings && ${name}_excess(it, level, closes, far, dt, &energy) >= 0; k++) {
    double next;
    width *= 2;
    next = closes ? a + width * fmax(a, $small) : fmax(a * (1 - width), least);
    if (next == far) break;
    near = far, far = next;
  }
  ends = ${name}_excess(it, level, closes, far, dt, &energy) < 0;
  for (k = 0; ends && k < $halvings; k++) {
    double middle = (near + far) / 2;
    if (${name}_excess(it, level, closes, middle, dt, &energy) < 0) far = middle;
    else near = middle;
  }
  return !closes && far < $gone ? 0 : far;
}

/* Move the edge to b if the storage does not rise. */
static inline void ${name}_cross($name *it, double b, double dt) {
  double a = it->radius, low = fmin(a, b), high = fmax(a, b), rate = fabs(b - a) / dt, D = it->depth;
  double other[$cells][$modes], kept[$modes], glassy = 1, spare, energy = 0, factor = 1;
  double area = ${name}_surface * ${name}_pi * fabs(b * b - a * a);
  int i, m, closes = b > a, first = ${name}_cell(low, 0), last = ${name}_cell(high, 1);
  double zone = ${name}_row(${name}_zone_time, closes, rate);
  for (m = 0; m < ${name}_modes; m++) {
    kept[m] = 1 / (1 + zone / ${name}_time[m]);
    glassy += ${name}_modulus[m];
  }
  spare = closes ? area : -area;
  for (i = first; i <= last; i++) {
    double s = fmax(${name}_node[i], low), t = fmin(${name}_node[i + 1], high), part = t - s;
    double level = D - ${name}_square(s, t), pressed = ${name}_pressed(D, s, t);
    if (!(part > 0)) continue;
    if (closes) {
      double jump = level + ${name}_sum(it->outer[i]);
      for (m = 0; m < ${name}_modes; m++) other[i][m] = (it->outer[i][m] + jump) * kept[m];
      spare += part * ${name}_stored(it->outer[i]) - pressed;
      energy += part * ${name}_squares(other[i]);
    } else {
      double chi = (level + ${name}_sum(it->inner[i])) / glassy, free[$modes];
      for (m = 0; m < ${name}_modes; m++) free[m] = it->inner[i][m] - chi;
      ${name}_recover(free, kept, other[i]);
      spare += pressed + part * ${name}_squares(it->inner[i]);
      energy += part * ${name}_stored(other[i]);
    }
  }
  it->rate = 0;
  if (b == a || !(spare >= 0)) return;
  if (energy > spare) factor = sqrt(spare / energy);
  for (i = first; i <= last; i++) {
    double part = ${name}_part(i, low, high), inside = ${name}_part(i, 0, a);
    if (!(part > 0)) continue;
    for (m = 0; m < ${name}_modes; m++) other[i][m] *= factor;
    if (closes) ${name}_mix(it->inner[i], inside, other[i], part);
    else ${name}_mix(it->outer[i], ${name}_node[i + 1] - ${name}_node[i] - inside, other[i], part);
  }
  it->radius = b, it->rate = (b - a) / dt, it->way = closes ? 1 : -1;
  if (closes) it->front = b;
}

/* Advance by dt [s] to a depth [m]; returns the force at the end [N], NAN if it is not possible.
 * mean, if not NULL, is set to the mean force of the step: times the change of depth, its work. */
static inline double ${name}_step($name *it, double depth, double dt, double *mean) {
  double D = depth / ${name}_length, moved = D - it->depth, a = it->radius, b = a, arms = 0, work = 0;
  double x[$modes], kept[$modes], lost[$modes], share[$modes], half[$modes], free[$modes];
  double inside[$cells], above[$cells], lift, jump, force;
  int i, m, opens, closes, turns, onwards, loose;
  if (mean) *mean = NAN;
  if (!(dt > 0) || !isfinite(D)) return NAN;
  for (m = 0; m < ${name}_modes; m++) {
    x[m] = dt / ${name}_time[m];
    kept[m] = 1 / (1 + x[m]);
    lost[m] = -expm1(-x[m]);
    share[m] = lost[m] / x[m];
    half[m] = x[m] < $series ? 0.5 - x[m] / 6 + x[m] * x[m] / 24 : (1 - share[m]) / x[m];
  }
  /* the bulk, at constant radius */
  for (i = 0; i < ${name}_cells && ${name}_node[i] < a; i++) {
    double force = 0, *e = it->inner[i];
    for (m = 0; m < ${name}_modes; m++) {
      force += (e[m] * share[m] + moved * half[m]) * ${name}_modulus[m];
      e[m] = e[m] * (1 - lost[m]) + moved * share[m];
    }
    arms += ${name}_part(i, 0, a) * force;
  }
  force = 2 * (a * ((it->depth + D) / 2 - a * a / 3) + arms);
  /* ground that the sphere meets before the edge */
  for (i = 0; moved > 0 && i < ${name}_cells; i++) {
    double touch = sqrt(fmax(D + ${name}_sum(it->outer[i]), 0.0));
    touch = fmin(touch, ${name}_node[i + 1]);
    if (touch > fmax(${name}_node[i], a)) b = touch;
  }
  for (i = 0; b > a && i < ${name}_cells; i++) {
    double low = fmax(${name}_node[i], a), high = fmin(${name}_node[i + 1], b), over, *e = it->outer[i];
    if (!(high > low)) continue;
    over = D + ${name}_sum(e) - ${name}_square(low, high);
    for (m = 0; m < ${name}_modes; m++) free[m] = e[m] + share[m] * over;
    work += ${name}_pressed(D, low, high) + (high - low) * (${name}_squares(free) - ${name}_stored(e));
    ${name}_mix(it->inner[i], ${name}_part(i, 0, a), free, high - low);
  }
  if (mean) *mean = (force + (work > 0 ? work / moved : 0)) * ${name}_newton;
  if (b > a) it->front = b;
  it->depth = D, it->radius = a = b;
  /* recovery of free annuli; strains too small to matter are denormal numbers, which are slow */
  for (i = 0; i < ${name}_cells; i++) {
    double low = fmax(${name}_node[i], a), rise, *e = it->outer[i];
    inside[i] = ${name}_node[i] < a ? ${name}_sum(it->inner[i]) : 0, above[i] = 0;
    if (${name}_node[i + 1] <= a) continue;
    rise = ${name}_recover(e, kept, free);
    for (m = 0; m < ${name}_modes && !(D - low * low > rise); m++)
      e[m] = fabs(free[m]) > 1e-150 ? free[m] : 0;
    above[i] = ${name}_sum(e);
  }
  /* the edge */
  ${name}_excess(it, inside, 0, fmax(a, 1e-12), 0, &lift);
  ${name}_excess(it, above, 1, fmax(a, 1e-12), 0, &jump);
  opens = a > 0 && lift > ${name}_surface * (1 + $rest);
  closes = jump < ${name}_surface * (1 - $rest);
  turns = it->way == 0 ||
          (it->way * moved < 0 && fabs(it->rate) * 2 * a < $against * fabs(moved / dt));
  onwards = turns ? moved < 0 : it->way < 0;
  loose = it->way * moved <= 0;
  if (opens && closes) opens = onwards, closes = !onwards;
  else opens = opens && (loose || it->way < 0), closes = closes && (loose || it->way > 0);
  if (opens) ${name}_cross(it, ${name}_follow(it, inside, 0, dt), dt);
  else if (closes) ${name}_cross(it, ${name}_follow(it, above, 1, dt), dt);
  else it->rate = 0;
  return ${name}_force(it);
}
#endif
