// The case, and what is known of it. Views listen; nothing here draws.

import { MOST_KEPT } from "./dom.js";
import { ask, cancel, follow, start } from "./server.js";

const REST = 80; // milliseconds for which numbers must rest before they are simulated
const IDLE = { state: "idle", share: 0, depth: [], force: [], error: "", answer: null, job: null, version: -1 };

export class Store extends EventTarget {
  tables = {};
  settings = { accuracy: 0.005, until: "detached" };
  quick = null;
  refused = "";
  run = IDLE;
  verdict = null;
  theory = null;
  kept = [];
  rig = null;
  auto = true;
  version = 0;
  answered = 0; // the version of the case that `quick` is of

  constructor(forms, operations) {
    super();
    Object.assign(this, { forms, operations: Object.fromEntries(operations.map((one) => [one.word, one])) });
  }

  // What was said of the present case, null while it is of the case before.
  now(name) {
    return this[name]?.version === this.version ? this[name] : null;
  }

  // The answer of a simulation of the present case, where it has one.
  get simulated() {
    return this.run.state === "done" ? this.now("run")?.answer ?? null : null;
  }

  // The numbers of `viscotack.predict`, which ranks the tiers: from the surrogates at once, else from the theories; where
  // it refuses, those of the simulation. Null while they are being computed.
  get best() {
    if (!this.quick || this.answered !== this.version) return null;
    const verdict = this.now("verdict"), numbers = this.quick.numbers.length ? this.quick.numbers : verdict?.numbers;
    if (!numbers || numbers.length) return numbers ?? null;
    if (["queued", "running"].includes(this.now("run")?.state ?? (this.auto ? "queued" : ""))) return null;
    if (!this.simulated) return [];
    const { pull, work, error } = this.simulated, more = { method: "simulation", why: verdict.refused };
    return [
      { name: this.quick.axes.pulled.name, value: pull, error: error.force, ...more },
      { name: "work_to_pull_off", value: work, error: error.work, ...more },
    ].filter(({ value }) => value !== null);
  }

  say(name, detail) {
    this.dispatchEvent(new CustomEvent(name, { detail }));
  }

  on(names, listener) {
    for (const name of names.split(" ")) this.addEventListener(name, listener);
  }

  // Take a case: at once what is known at once, a simulation when it rests.
  take(tables) {
    this.tables = structuredClone(tables);
    this.version += 1;
    this.say("case");
    this.stop();
    this.askQuick();
  }

  // Change some tables of the case, or a number of one; null takes it away.
  change(tables) {
    this.take({ ...this.tables, ...tables });
  }

  set(table, key, value) {
    const { [key]: before, ...others } = this.tables[table] || {};
    if (value === null || value === "") this.change({ [table]: others });
    else this.change({ [table]: { ...this.tables[table], [key]: value } });
  }

  configure(settings) {
    Object.assign(this.settings, settings);
    this.take(this.tables);
  }

  async askQuick() {
    if (this.asking) return; // the last case is asked for when the answer has come
    this.asking = true;
    const { version } = this;
    try {
      this.quick = await ask("/api/quick", { problem: this.tables });
      this.answered = version;
      this.refused = "";
      clearTimeout(this.linking);
      this.linking = setTimeout(() => this.link(), 150);
    } catch (error) {
      this.refused = error.message;
    }
    this.asking = false;
    this.say("quick");
    if (version !== this.version) this.askQuick();
    else if (!this.refused) this.resting = setTimeout(() => (this.auto ? this.simulate() : this.judge()), REST);
  }

  // The address is the state: a reload, or whoever gets the link, sees the same.
  get address() {
    const state = { case: this.tables, ...this.settings, kept: this.kept.map(({ tables }) => tables) };
    return `/?${new URLSearchParams({ state: JSON.stringify(state) })}${location.hash}`;
  }

  link() {
    history.replaceState(null, "", this.address);
  }

  async simulate() {
    this.stop();
    const run = this.run = { ...IDLE, depth: [], force: [], state: "queued", version: this.version }, began = performance.now();
    this.say("run");
    const judging = setTimeout(() => run === this.run && this.judge(), 1500);
    try {
      const asked = { problem: this.tables, ...this.settings, time_limit: 300, profiles: true };
      run.job = await start("simulate", asked, { outputs: ["drawn"] });
      if (run !== this.run) { cancel(run.job); return; }
      const answer = await follow(run.job, (news) => {
        if (run !== this.run) return;
        if (["queued", "running"].includes(news.state)) run.state = news.state; // done is said with the answer
        run.share = news.share;
        for (const [, depth, force] of news.points) { run.depth.push(depth); run.force.push(force); }
        this.say("run");
      });
      if (run !== this.run || !answer) return;
      run.answer = told(answer);
      run.state = run.answer.failed ? "stopped" : "done";
      run.took = performance.now() - began;
      cancel(run.job); // it has been read, and need not be kept there
    } catch (error) {
      if (run !== this.run) return;
      run.state = "refused";
      run.error = error.message;
    } finally {
      clearTimeout(judging);
    }
    this.say("run");
    this.judge();
  }

  // End what goes on; its curve stays, marked as one of another case.
  stop(words = "") {
    clearTimeout(this.resting);
    this.judging?.abort();
    this.judged = null;
    if (!["queued", "running"].includes(this.run.state)) return;
    if (this.run.job) cancel(this.run.job);
    this.run = { ...this.run, state: "cancelled", error: words, job: null };
    this.say("run");
  }

  // Ask what is known of the case by every method, then the theories that take seconds.
  async judge() {
    if (this.judged === this.version) return;
    this.judged = this.version;
    const { version, tables: problem } = this, { signal } = this.judging = new AbortController();
    const tell = (name, answer) => { if (version === this.version) { this[name] = { ...answer, version, axes: this.quick.axes }; this.say("verdict"); } };
    try {
      tell("verdict", await ask("/api/verdict", { problem }, { signal }));
      tell("theory", await ask("/api/theory", { problem }, { signal }));
    } catch (error) {
      if (error.name !== "AbortError" && !this.now("verdict")) tell("verdict", { numbers: [], refused: error.message, words: [], tiers: [] });
    }
  }

  keep(tables = this.tables, quick = this.quick, answer = this.simulated) {
    if (this.kept.length >= MOST_KEPT || !quick) return;
    this.keepAll([...this.kept, { tables, quick, answer }]);
  }

  keepAll(kept) {
    this.kept = kept;
    this.link();
    this.say("kept");
  }
}

// The answer of a simulation: its summary as the command prints it, the pull-off, that of a punch as a stress, the work, their
// errors, and its curve in SI, with the force positive in compression.
function told({ beside, ...summary }) {
  const { depth_m: depth, time_s: time, force_N, stress_Pa } = beside.drawn.columns;
  return {
    ...beside.drawn, summary, error: summary.error_estimate || {}, curve: { depth, time, force: force_N || stress_Pa.map((x) => (x === null ? null : -x)) },
    pull: summary.pull_off_force_N ?? summary.pull_off_stress_Pa ?? null, work: summary.work_to_pull_off_J ?? summary.work_to_pull_off_J_per_m2 ?? null,
  };
}
