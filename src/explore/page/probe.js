// probe.js: all layers of one pixel, of both views, as the pictures refine.

import {make} from "./elements.js";
import {Feed} from "./feed.js";
import {short} from "./numbers.js";
import * as server from "./server.js";

function pixelOf(view, {u, v}, {width, height, picture}) {
    return {view, x: Math.floor(u * width), y: Math.floor(v * height), picture};
}

export class Probe {
    // Elements: root, title, table, note.
    constructor({root, title, table, note}) {
        this.root = root;
        this.title = title;
        this.table = table;
        this.note = note;
        this.place = null;
        this.feed = new Feed(({pixels}) => Promise.all(pixels.map(
            ({view, x, y}) => server.get(`pixel/${view}?x=${x}&y=${y}`))),
            (answers, wanted) => this.fill(answers, wanted), (problem) => this.tell(problem.message));
    }

    // A point of the pictures, {u, v} in 0..1, as they may have different sizes; or null to close it.
    turnTo(place) {
        this.place = place;
        this.feed.forget();
        this.title.textContent = "Pixel";
        this.table.replaceChildren();
        this.root.hidden = !place;
    }

    // Previews have fewer pixels: what they have is not asked for.
    show(state) {
        if (!this.place)
            return;
        const present = ["a", "b"].filter((view) => state.views[view]);
        const whole = present.filter((view) => state.views[view].passes > 0 && !state.views[view].preview);
        const pixels = whole.map((view) => pixelOf(view, this.place, state.views[view]));
        if (pixels.length > 0)
            this.feed.want({pixels, has_two: present.length > 1});
        this.tell(whole.length < present.length ? "The first pass brings its values." : "");
    }

    tell(text) {
        this.note.textContent = text;
    }

    fill(answers, {pixels, has_two}) {
        const rows = [], texts = pixels.map(({x, y}) => `${x}, ${y}`);
        answers.forEach(({layers}, i) => {
            const view = pixels[i].view, where = texts[i] === texts[0] ? "" : ` ${texts[i]}`;
            if (has_two)
                rows.push(make("tr", {class: view}, make("th", {scope: "rowgroup"}, view.toUpperCase() + where)));
            for (const [name, values] of Object.entries(layers)) {
                rows.push(make("tr", {}, make("th", {scope: "row"}, name),
                    ...values.map((value) => make("td", {}, short(value ?? NaN, 4)))));
            }
        });
        this.title.textContent = `Pixel ${texts[0]}`;
        this.table.replaceChildren(...rows);
    }
}
