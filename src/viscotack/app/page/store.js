// The case, and what is known of it. Views listen; nothing here draws.

import { ask, cancel, follow } from "./server.js";
import { pulledBy, workOf } from "./numbers.js";

// Milliseconds for which numbers must rest before they are simulated.
const REST = 80;
const PAGE_KEYS = ["accuracy", "until"];
const MOST_KEPT = 4;

export class Store extends EventTarget {
  constructor(forms) {
    super();
    this.forms = forms;
    this.tables = {};
    this.settings = { accuracy: 0.005, until: "detached" };
    this.quick = null;
    this.refused = "";
    this.run = idle();
    this.verdict = null;
    this.theory = null;
    this.kept = [];
    this.rig = null;
    this.auto = true;
    this.times = [];
    this.version = 0;
    this.answered = 0; // the version of the case that `quick` is of
  }

  // The numbers of `viscotack.predict`, which ranks the tiers: from the surrogates at once, else from the theories; where
  // it refuses, those of the simulation. Null while they are being computed.
  get best() {
    const { quick, run } = this, verdict = this.verdict?.version === this.version ? this.verdict : null;
    if (!quick || this.answered !== this.version) return null;
    const numbers = quick.numbers.length ? quick.numbers : verdict ? verdict.numbers : null;
    if (!numbers || numbers.length) return numbers;
    if (run.version !== this.version || !["done", "stopped", "refused"].includes(run.state)) return null;
    if (run.state !== "done") return [];
    const { summary } = run.answer, error = summary.error_estimate || {};
    const force = "pull_off_force" in quick.axes ? "pull_off_force" : "pull_off_stress";
    return [
      { name: force, value: pulledBy(summary), error: error.force, method: "simulation", why: verdict.refused },
      { name: "work_to_pull_off", value: workOf(summary), error: error.work, method: "simulation", why: verdict.refused },
    ].filter(({ value }) => value !== null && value !== undefined);
  }

  say(name, detail) {
    this.dispatchEvent(new CustomEvent(name, { detail }));
  }

  // Take a case: at once what is known at once, a simulation when it rests.
  take(tables, { began = performance.now() } = {}) {
    this.tables = tables;
    this.version += 1;
    this.say("case");
    this.stop();
    this.began = began;
    clearTimeout(this.resting);
    this.askQuick();
  }

  set(table, key, value, more) {
    const tables = structuredClone(this.tables);
    tables[table] = { ...tables[table] };
    if (value === null || value === "") delete tables[table][key];
    else tables[table][key] = value;
    this.take(tables, more);
  }

  configure(name, value) {
    this.settings = { ...this.settings, [name]: value };
    this.take(this.tables);
  }

  async askQuick() {
    if (this.asking) return; // the last case is asked for when the answer has come
    this.asking = true;
    const version = this.version, began = this.began;
    try {
      this.quick = await ask("/api/quick", { tables: this.tables, ...this.settings });
      this.answered = version;
      this.refused = "";
    } catch (error) {
      this.refused = error.message;
    }
    this.asking = false;
    if (!this.refused) this.link();
    this.say("quick");
    this.times.push(performance.now() - began);
    if (this.times.length > 2500) this.times.splice(0, 500);
    if (version !== this.version) this.askQuick();
    else if (!this.refused && this.auto) this.resting = setTimeout(() => this.simulate(), REST);
  }

  // The query of the address is the case: a reload, or whoever gets the link, sees the same.
  link() {
    clearTimeout(this.linking);
    this.linking = setTimeout(() => history.replaceState(null, "", this.address()), 150);
  }

  address() {
    const more = new URLSearchParams();
    for (const name of PAGE_KEYS) more.set(name, this.settings[name]);
    for (const one of this.kept) more.append("keep", one.query);
    return `/?${this.quick ? this.quick.query : ""}&${more}${location.hash}`;
  }

  async simulate() {
    this.stop();
    const run = this.run = { ...idle(), state: "queued", began: performance.now(), version: this.version };
    this.say("run");
    const judging = setTimeout(() => this.judge(run), 1500);
    try {
      const asked = { problem: this.tables, ...this.settings, time_limit: 300, profiles: true, outputs: ["drawn"] };
      run.job = await ask("/api/jobs/simulate", asked);
      if (run !== this.run) { cancel(run.job); return; }
      const answer = await follow(run.job, (news) => {
        if (run !== this.run) return;
        if (["queued", "running"].includes(news.state)) run.state = news.state; // done is said with the answer
        run.share = news.share;
        for (const [, depth, force] of news.points) { run.depth.push(depth); run.force.push(force); }
        this.say("run");
      });
      if (run !== this.run || !answer) return;
      const { beside, ...summary } = answer;
      run.answer = { ...beside.drawn, summary };
      run.state = run.answer.failed ? "stopped" : "done";
      run.took = performance.now() - run.began;
      cancel(run.job); // it has been read, and need not be kept there
    } catch (error) {
      if (run !== this.run) return;
      run.state = "refused";
      run.error = error.message;
    } finally {
      clearTimeout(judging);
    }
    this.say("run");
    this.judge(run);
  }

  // End what goes on; its curve stays, marked as one of another case.
  stop(words = "") {
    clearTimeout(this.resting);
    const run = this.run;
    if (this.judging) this.judging.abort();
    if (run.job && !["done", "stopped", "refused"].includes(run.state)) {
      const began = performance.now();
      cancel(run.job).then(() => { this.cancelled = performance.now() - began; this.say("cancelled"); });
    }
    if (["queued", "running"].includes(run.state)) {
      this.run = { ...run, state: "cancelled", error: words, job: null };
      this.say("run");
    }
  }

  async judge(run) {
    if (run.judged || run !== this.run) return;
    run.judged = true;
    const version = this.version;
    this.judging = new AbortController();
    const { signal } = this.judging, asked = { tables: this.tables };
    try {
      const verdict = await ask("/api/verdict", asked, { signal });
      if (version !== this.version) return;
      this.verdict = { ...verdict, version };
      this.say("verdict");
      const speeds = !this.quick.speeds;
      if (!speeds && !verdict.crack) return;
      const theory = await ask("/api/theory", { ...asked, speeds, crack: verdict.crack }, { signal });
      if (version === this.version) { this.theory = { ...theory, version }; this.say("verdict"); }
    } catch (error) {
      if (error.name !== "AbortError" && version === this.version) {
        this.verdict = { numbers: [], refused: error.message, words: [], tiers: [], version };
        this.say("verdict");
      }
    }
  }

  keep() {
    if (this.kept.length >= MOST_KEPT || !this.quick) return;
    const run = this.run, done = run.state === "done" && run.version === this.version;
    this.kept.push({
      tables: this.tables, query: this.quick.query, quick: this.quick,
      columns: done ? curveOf(run.answer) : null, summary: done ? run.answer.summary : null,
    });
    history.replaceState(null, "", this.address());
    this.say("kept");
  }

  forget(index) {
    this.kept.splice(index, 1);
    history.replaceState(null, "", this.address());
    this.say("kept");
  }
}

export function idle() {
  return { state: "idle", share: 0, depth: [], force: [], error: "", answer: null, job: null, version: -1 };
}

// Depth and force of a result in SI, force positive in compression.
export function curveOf(answer) {
  const columns = answer.columns;
  if (columns.force_N) return { depth: columns.depth_m, force: columns.force_N, radius: columns.contact_radius_m, time: columns.time_s };
  return { depth: columns.depth_m, force: columns.stress_Pa.map((x) => (x === null ? null : -x)), radius: columns.ligament_m, time: columns.time_s };
}
