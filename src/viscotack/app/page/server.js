// The way to the server: the same API that anybody else asks.

export class Refused extends Error {}

export async function ask(path, body, { method = body === undefined ? "GET" : "POST", signal } = {}) {
  const options = { method, signal };
  if (body instanceof FormData) options.body = body;
  else if (body !== undefined) {
    options.body = JSON.stringify(body);
    options.headers = { "content-type": "application/json" };
  }
  let response;
  try {
    response = await fetch(path, options);
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Refused("the server does not answer; is viscotack app still running?");
  }
  const answer = await response.json().catch(() => ({ error: `the server answered with status ${response.status}` }));
  if (!response.ok) throw new Refused(answer.error || `the server answered with status ${response.status}`);
  return answer;
}

// Follow a job until it is over; news is given what is new, and its answer is returned.
export async function follow(job, news) {
  let points = 0, rows = 0;
  for (;;) {
    const found = await ask(`/api/jobs/${job.id}?wait=5&points_from=${points}&rows_from=${rows}`);
    if (job.gone) return null;
    points += found.points.length;
    rows += found.rows.length;
    news(found);
    if (found.answer) return found.answer;
    if (found.error) throw new Refused(found.error);
  }
}

export function cancel(job) {
  job.gone = true;
  return ask(`/api/jobs/${job.id}`, undefined, { method: "DELETE" }).catch(() => null);
}
