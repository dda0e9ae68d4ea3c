/* Force of a contact by the depth and speed of its retraction, and a controller that lets it go.
 *
 * Made by viscotack $version for: $of
 * In SI. Depths and forces are positive into the solid and in compression, speeds of the contact
 * positive. Largest error of a force over the pull-off force: $error.
 * C99 or C++, needs only math.h. Copyright of this file: none (CC0).
 */
#ifndef ${guard}_H
#define ${guard}_H
#include <math.h>

enum { ${name}_speeds = $speeds, ${name}_shares = $shares, ${name}_peak = $peak };
static const double ${name}_start_depth = $start_depth;
static const double ${name}_speed[$speeds] = {$speed};
/* travels from the start to the pull-off, to half of its force, to the end */
static const double ${name}_travel[$speeds][3] = {$travel};
/* shares of the way: 0 start, 1 pull-off, 2 half of its force, 3 end */
static const double ${name}_share[$shares] = {$share};
static const double ${name}_row[$speeds][$shares] = {$force};

/* Row below a speed, and in part the way to the next; -1 outside the table. */
static inline int ${name}_between(double speed, double *part) {
  int low = 0, high = ${name}_speeds - 1;
  const double *v = ${name}_speed;
  if (!(speed >= v[0] && speed <= v[high])) return -1;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (v[middle] <= speed) low = middle; else high = middle;
  }
  *part = log(speed / v[low]) / log(v[low + 1] / v[low]);
  return low;
}

/* Force [N] and its derivative by the depth [N/m]; 1 where there is one, 0 and NAN where not. */
static inline int ${name}_force(double depth, double speed, double *force, double *slope) {
  double part = 0, before, way, u, travel[3], left, right, width;
  double gone = ${name}_start_depth - depth;
  int i = ${name}_between(speed, &part), leg, j, low = 0, high = ${name}_shares - 1;
  *force = *slope = NAN;
  if (i < 0 || !(gone >= 0)) return 0;
  for (j = 0; j < 3; j++)
    travel[j] = ${name}_travel[i][j] + part * (${name}_travel[i + 1][j] - ${name}_travel[i][j]);
  *force = *slope = 0;
  if (gone >= travel[2]) return 1;
  leg = (gone > travel[0]) + (gone > travel[1]);
  before = leg == 0 ? 0 : travel[leg - 1];
  way = travel[leg] - before;
  u = leg + (gone - before) / way;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (${name}_share[middle] < u) low = middle; else high = middle;
  }
  left = ${name}_row[i][low] + part * (${name}_row[i + 1][low] - ${name}_row[i][low]);
  right = ${name}_row[i][high] + part * (${name}_row[i + 1][high] - ${name}_row[i][high]);
  width = ${name}_share[high] - ${name}_share[low];
  *force = left + (u - ${name}_share[low]) * ((right - left) / width);
  *slope = -((right - left) / width) / way;
  return 1;
}

/* Pull-off force [N] at a speed, positive; NAN outside the table. */
static inline double ${name}_pull_off_force(double speed) {
  double part = 0, here, next;
  int i = ${name}_between(speed, &part);
  if (i < 0) return NAN;
  here = -${name}_row[i][${name}_peak], next = -${name}_row[i + 1][${name}_peak];
  return here + part * (next - here);
}

/* Slowest speed of the contact [m/s] whose pull-off force is wanted; NAN if none is. */
static inline double ${name}_speed_for(double wanted) {
  int i;
  for (i = 0; i + 1 < ${name}_speeds; i++) {
    double here = -${name}_row[i][${name}_peak], next = -${name}_row[i + 1][${name}_peak];
    if ((here <= wanted && wanted <= next) || (next <= wanted && wanted <= here)) {
      double part = here == next ? 0 : (wanted - here) / (next - here);
      return ${name}_speed[i] * pow(${name}_speed[i + 1] / ${name}_speed[i], part);
    }
  }
  return NAN;
}

/* A controller; start it, then ask it for the speed of the drive once in a period. */
typedef struct {
  double speed, stiffness, period, fastest, tension;
  long ticks;
  int past;
} ${name}_release;

/* 1 if it started, 0 if no speed has the wanted pull-off force [N]. stiffness: of the spring between
 * drive and indenter [N/m], INFINITY without one; period [s]; fastest: speed of the drive [m/s]. */
static inline int ${name}_start(${name}_release *it, double wanted, double stiffness, double period,
                                double fastest) {
  it->speed = ${name}_speed_for(wanted);
  it->stiffness = stiffness, it->period = period, it->fastest = fastest, it->tension = 0;
  it->ticks = 0, it->past = 0;
  return !isnan(it->speed);
}

/* Speed of the drive [m/s], negative pulls, from its position [m] and the force [N] now. */
static inline double ${name}_drive_speed(${name}_release *it, double drive, double force) {
  double aim, at, slope, to, speed, step = it->speed * it->period, late;
  double depth = drive - force / it->stiffness;
  it->ticks += 1;
  if (-force > it->tension) it->tension = -force;
  if (it->tension > 0 && -force < (1 - $past) * it->tension) it->past = 1;
  if (it->past) return -fmin(it->speed, it->fastest);
  late = (depth - (${name}_start_depth - (double)it->ticks * step)) / step;
  aim = depth - step * fmin(fmax(late, 1 - $catch_up), 1 + $catch_up);
  ${name}_force(aim, it->speed, &at, &slope);
  if (!(slope > 0)) slope = 0;
  to = aim + (force + slope * (aim - depth)) / it->stiffness;
  speed = (to - drive) / it->period;
  return fmin(fmax(speed, -it->fastest), it->fastest);
}
#endif
