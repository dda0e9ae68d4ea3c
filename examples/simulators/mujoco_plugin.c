/* Adhesion with memory between two geoms, as an engine plugin of MuJoCo.
 *
 *     viscotack export contact pad_dome.toml -o contact.h
 *     cc -O2 -shared -fPIC mujoco_plugin.c -o contact.so -I include libmujoco.so -lm
 *
 * with the folder include and the library of MuJoCo. In the model:
 *
 *     <extension>
 *       <plugin plugin="viscotack.contact">
 *         <instance name="grip">
 *           <config key="geom1" value="pad"/>
 *           <config key="geom2" value="load"/>
 *           <config key="count" value="64"/>     domes on the pad, 1 if left out
 *         </instance>
 *       </plugin>
 *     </extension>
 *     ... <body ...><plugin instance="grip"/> ... </body>
 *
 * mj_loadPluginLibrary("contact.so") comes before the model. The two geoms have no contact of
 * MuJoCo's own (contype="0"). The memory is in mjData.plugin_state: it is copied, reset and saved
 * with the data. Copyright of this file: none (CC0).
 */
#include <math.h>
#include <mujoco/mujoco.h>
#include <stdlib.h>
#include <string.h>

#include "contact.h"

/* Contact, and the time [s] up to which it is known; negative before the first step. */
typedef struct {
  contact it;
  double time;
} Memory;

/* What the instance is made of, and its memory with the step under way. */
typedef struct {
  int geom[2];
  double count, normal[3];
  Memory next;
} Instance;

static int number_of_states(const mjModel *m, int instance) {
  (void)m, (void)instance;
  return (int)((sizeof(Memory) + sizeof(mjtNum) - 1) / sizeof(mjtNum));
}

static int init(const mjModel *m, mjData *d, int instance) {
  const char *names[2] = {"geom1", "geom2"}, *count = mj_getPluginConfig(m, instance, "count");
  Instance *own = calloc(1, sizeof(Instance));
  int i;
  if (!own) return -1;
  own->count = count && *count ? atof(count) : 1;
  for (i = 0; i < 2; i++) {
    own->geom[i] = mj_name2id(m, mjOBJ_GEOM, mj_getPluginConfig(m, instance, names[i]));
    if (own->geom[i] < 0) mju_error("viscotack.contact: %s is no geom of the model", names[i]);
  }
  if (!(own->count > 0)) mju_error("viscotack.contact: count must be positive");
  if (m->opt.integrator == mjINT_RK4)
    mju_error("viscotack.contact: a contact with memory cannot go back in time; not RK4");
  d->plugin_data[instance] = (uintptr_t)own;
  return 0;
}

static void destroy(mjData *d, int instance) {
  free((void *)d->plugin_data[instance]);
  d->plugin_data[instance] = 0;
}

static void reset(const mjModel *m, mjtNum *state, void *data, int instance) {
  (void)m, (void)data, (void)instance;
  ((Memory *)state)->time = -1;
}

/* A step from the known memory; it counts when the time advances. */
static void compute(const mjModel *m, mjData *d, int instance, int type) {
  Instance *own = (Instance *)d->plugin_data[instance];
  Memory *next = &own->next;
  double way[6], distance, force, length, push[3], middle[3];
  int i;
  (void)type;
  memcpy(next, d->plugin_state + m->plugin_stateadr[instance], sizeof(Memory));
  distance = mj_geomDistance(m, d, own->geom[0], own->geom[1], 1e3, way);
  if (next->time < 0) {
    contact_apart(&next->it, -distance);
    force = contact_force(&next->it);
  } else {
    double dt = d->time - next->time;
    force = dt > 0 ? contact_step(&next->it, -distance, dt, NULL) : contact_force(&next->it);
  }
  next->time = d->time;
  /* from the first geom to the second; a vanishing gap keeps the last direction */
  for (i = 0; i < 3; i++) push[i] = distance < 0 ? way[i] - way[i + 3] : way[i + 3] - way[i];
  length = sqrt(push[0] * push[0] + push[1] * push[1] + push[2] * push[2]);
  for (i = 0; i < 3; i++) {
    if (length > 1e-9) own->normal[i] = push[i] / length;
    push[i] = own->count * force * own->normal[i];
    middle[i] = (way[i] + way[i + 3]) / 2;
  }
  mj_applyFT(m, d, push, NULL, middle, m->geom_bodyid[own->geom[1]], d->qfrc_passive);
  for (i = 0; i < 3; i++) push[i] = -push[i];
  mj_applyFT(m, d, push, NULL, middle, m->geom_bodyid[own->geom[0]], d->qfrc_passive);
}

static void advance(const mjModel *m, mjData *d, int instance) {
  Instance *own = (Instance *)d->plugin_data[instance];
  memcpy(d->plugin_state + m->plugin_stateadr[instance], &own->next, sizeof(Memory));
}

mjPLUGIN_LIB_INIT(viscotack_contact) {
  static const char *attributes[] = {"geom1", "geom2", "count"};
  mjpPlugin plugin;
  mjp_defaultPlugin(&plugin);
  plugin.name = "viscotack.contact";
  plugin.nattribute = 3;
  plugin.attributes = attributes;
  plugin.capabilityflags = mjPLUGIN_PASSIVE;
  plugin.nstate = number_of_states;
  plugin.init = init;
  plugin.destroy = destroy;
  plugin.reset = reset;
  plugin.compute = compute;
  plugin.advance = advance;
  mjp_registerPlugin(&plugin);
}
