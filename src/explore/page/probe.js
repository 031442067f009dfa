// probe.js: all layers of one pixel, of both views, as the pictures refine.

import {make} from "./elements.js";
import {Feed} from "./feed.js";
import {short} from "./numbers.js";
import * as server from "./server.js";

export class Probe {
    // Elements: root, title, table.
    constructor({root, title, table}) {
        this.root = root;
        this.title = title;
        this.table = table;
        this.pixel = null;
        this.feed = new Feed(({views, x, y}) => Promise.all(views.map(
            (view) => server.get(`pixel/${view}?x=${x}&y=${y}`))), (answers, {views}) => this.fill(answers, views));
    }

    // {x, y}, or null to close it.
    turnTo(pixel) {
        this.pixel = pixel;
        this.root.hidden = true;
        this.feed.forget();
    }

    // Previews have fewer pixels: what they have is not asked for.
    show(state) {
        const views = ["a", "b"].filter((view) => state.views[view]?.picture > 0 && !state.views[view].preview);
        if (!this.pixel || views.length === 0)
            return;
        this.feed.want({...this.pixel, views, pictures: views.map((view) => state.views[view].picture)});
    }

    fill(answers, views) {
        const rows = [];
        answers.forEach(({layers}, i) => {
            if (views.length > 1)
                rows.push(make("tr", {class: views[i]}, make("th", {scope: "rowgroup"}, views[i].toUpperCase())));
            for (const [name, values] of Object.entries(layers)) {
                rows.push(make("tr", {}, make("th", {scope: "row"}, name),
                    ...values.map((value) => make("td", {}, short(value ?? NaN, 4)))));
            }
        });
        this.title.textContent = `Pixel ${this.pixel.x}, ${this.pixel.y}`;
        this.table.replaceChildren(...rows);
        this.root.hidden = false;
    }
}
