// The way to the server: the same API that anybody else asks.

export async function ask(path, body, { method = body === undefined ? "GET" : "POST", signal } = {}) {
  const form = body instanceof FormData;
  const options = { method, signal, headers: body === undefined || form ? {} : { "content-type": "application/json" }, body: form ? body : JSON.stringify(body) };
  const response = await fetch(path, options).catch((error) => { throw error.name === "AbortError" ? error : new Error("the server does not answer; is viscotack app still running?"); });
  const answer = await response.json().catch(() => ({}));
  if (!response.ok) throw new Error(answer.error || `the server answered with status ${response.status}`);
  return answer;
}

// Start the job of an operation; files are sent first, and named in the request.
export async function start(path, body, { files = [], outputs = [] } = {}) {
  const query = new URLSearchParams(outputs.map((name) => ["outputs", name]));
  if (files.length) {
    const form = new FormData();
    for (const file of files) form.append("files", file);
    query.set("files", (await ask("/api/files", form)).files);
  }
  return ask(`/api/jobs/${path}?${query}`, body);
}

// Follow a job until it is over; news is given what is new, and its answer is returned, null where it was cancelled.
export async function follow(job, news) {
  for (let points = 0; ;) {
    const found = await ask(`/api/jobs/${job.id}?wait=5&points_from=${points}`);
    if (job.gone) return null;
    points += found.points.length;
    news(found);
    if (found.answer) return found.answer;
    if (found.error) throw new Error(found.error);
  }
}

export function cancel(job) {
  job.gone = true;
  return ask(`/api/jobs/${job.id}`, undefined, { method: "DELETE" }).catch(() => null);
}
