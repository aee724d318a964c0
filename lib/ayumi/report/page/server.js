// The server of the live page: what it knows and what it can be asked. All addresses are relative
// to the page's address, whose first part is the secret token.

export class Server {
  /// `hooks` are the functions state(version), job(news), lost() and found().
  constructor(hooks) {
    this.hooks = hooks;
  }

  listen() {
    const source = new EventSource("events");
    source.addEventListener("state", (event) => this.hooks.state(JSON.parse(event.data).version));
    source.addEventListener("job", (event) => this.hooks.job(JSON.parse(event.data)));
    source.addEventListener("open", () => this.hooks.found());
    source.addEventListener("error", () => this.hooks.lost());
  }

  async state() {
    const answer = await fetch("state", { cache: "no-store" });
    if (!answer.ok) throw new Error(`the server answers ${answer.status}`);
    return answer.json();
  }

  async bytes(path) {
    const answer = await fetch(path, { cache: "no-store" });
    return answer.ok ? answer.arrayBuffer() : null;
  }

  async ask(method, path, body) {
    const answer = await fetch(path, { method, body: body && JSON.stringify(body),
      headers: body ? { "Content-Type": "application/json" } : {} });
    let value = {};
    try {
      value = await answer.json();
    } catch {
      // An empty answer has no other information than its status.
    }
    return { status: answer.status, value };
  }
}
