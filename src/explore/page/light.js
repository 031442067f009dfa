// light.js: which photons light the pixel that is probed, as lines over the picture, by the brightness that they bring.

import {Feed} from "./feed.js";
import {short} from "./numbers.js";
import * as server from "./server.js";

function luminance([r, g, b]) {
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

export class Light {
    // told() is called when there is something else to draw, or to read in `text`.
    constructor(told) {
        this.told = told;
        this.wanted = false;
        this.found = null; // {view, place, light}
        this.text = "";
        this.feed = new Feed(({view, x, y}) => server.get(`light/${view}?x=${x}&y=${y}`),
            (light, {view, place}) => this.take({view, place, light}),
            (problem) => this.say(problem.message));
    }

    say(text) {
        this.text = text;
        this.told();
    }

    take(found) {
        const {irradiance, count, photons} = found.light;
        this.found = found;
        this.say(`${short(luminance(irradiance), 4)} W/m² by ${count} of ${photons} photons of the first pass`);
    }

    // The pixel at {u, v} of a view whose state says the size and the options; or null for none.
    turnTo(view, place, state) {
        if (!this.wanted || !place || !state) {
            this.feed.forget();
            this.found = null;
            this.say("");
            return;
        }
        const [width, height] = (state.values.size || "1x1").split("x").map(Number);
        const wanted = {view, place, x: Math.floor(place.u * width), y: Math.floor(place.v * height), of: state.command};
        if (this.found?.view !== view || this.found.place !== place)
            this.found = null;
        this.feed.want(wanted);
    }

    // Lines from the photons to the pixel; `at` takes a place in the picture, in its pixels, to the canvas, and `frame()` tells
    // the picture's size.
    draw(view, context, at, frame) {
        if (!this.wanted || this.found?.view !== view)
            return;
        const {place, light} = this.found, {width, height} = frame(), [x, y] = at([place.u * width, place.v * height]);
        const brightest = light.sources.length > 0 ? luminance(light.sources[0].irradiance) : 1;
        for (const {place: from, seen, irradiance} of light.sources.slice().reverse()) {
            if (!from)
                continue;
            const share = Math.sqrt(luminance(irradiance) / brightest), [left, top] = at(from);
            context.strokeStyle = context.fillStyle = `hsl(${20 + 40 * share} 100% ${35 + 45 * share}% / ${seen ? 0.9 : 0.35})`;
            context.beginPath();
            context.moveTo(left, top);
            context.lineTo(x, y);
            context.stroke();
            if (seen)
                context.fillRect(left - 2, top - 2, 4, 4);
        }
    }
}
