// server.js: what the page asks of the program that serves it. Addresses are relative: the page's own holds the token.

// A setting that the program refuses: its message is shown beside what was set.
export class Refused extends Error {}

async function answer(response) {
    if (response.ok)
        return response;
    let message = `${response.status} ${response.statusText}`;
    try {
        message = (await response.json()).message || message;
    } catch {
        // No JSON: the status has to do.
    }
    throw response.status === 422 ? new Refused(message) : new Error(message);
}

export async function get(path) {
    return (await answer(await fetch(path))).json();
}

export async function put(path, body) {
    await answer(await fetch(path, {
        method: "PUT",
        headers: {"Content-Type": "application/json"},
        body: JSON.stringify(body),
    }));
}

export async function remove(path) {
    await answer(await fetch(path, {method: "DELETE"}));
}

// A picture: {width, height, channels, number, samples}, rows from the top; null where there is none.
export async function getPicture(path) {
    const response = await fetch(path);
    if (response.status === 404)
        return null;
    const bytes = await (await answer(response)).arrayBuffer();
    const [width, height, channels, number] = new Uint32Array(bytes, 0, 4);
    return {width, height, channels, number, samples: new Float32Array(bytes, 16)};
}

// A view of which no scene could be loaded yet has no strategies and values.
function completed(state) {
    for (const [name, view] of Object.entries(state.views))
        state.views[name] = view && {strategies: {}, parameters: {}, values: {}, ...view};
    return state;
}

// The state, now and at each change, for as long as the page is seen: a browser has few connections to one server, and
// pages that nobody looks at shall not hold them. `lost` is told whether the program answers.
export function watchState(changed, lost) {
    let events = null;
    const open = () => {
        events = new EventSource("events");
        events.addEventListener("state", (event) => {
            lost(false);
            changed(completed(JSON.parse(event.data)));
        });
        events.onerror = () => lost(true);
    };
    const follow = () => {
        if (!document.hidden && !events) {
            open();
        } else if (document.hidden && events) {
            events.close();
            events = null;
        }
    };
    document.addEventListener("visibilitychange", follow);
    follow();
}
