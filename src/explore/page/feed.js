// feed.js: the newest of something that changes faster than it can be fetched. One request at a time is under way; of
// what is wanted meanwhile, the last is fetched next: a slow browser skips pictures, and falls behind by one at most.

export class Feed {
    // fetch(wanted) returns a promise; arrived(value, wanted) is called with what it gives, failed(problem, wanted) where it
    // gives nothing.
    constructor(fetch, arrived, failed = () => {}) {
        this.fetch = fetch;
        this.arrived = arrived;
        this.failed = failed;
        this.key = null;
        this.next = null;
        this.busy = false;
    }

    // Asks for `wanted` unless it is the last that was asked for.
    want(wanted) {
        const key = JSON.stringify(wanted);
        if (key === this.key)
            return;
        this.key = key;
        this.next = wanted;
        this.run();
    }

    // What was asked for counts no longer: what arrives of it is dropped, and it may be asked for again.
    forget() {
        this.key = null;
        this.next = null;
    }

    async run() {
        if (this.busy)
            return;
        this.busy = true;
        while (this.next !== null) {
            const wanted = this.next;
            this.next = null;
            try {
                const value = await this.fetch(wanted);
                if (this.key !== null)
                    this.arrived(value, wanted);
            } catch (problem) {
                // The program is gone, or what was asked for is. It is not asked for again; the next state tells more.
                console.warn(`${JSON.stringify(wanted)}: ${problem.message}`);
                if (this.key !== null)
                    this.failed(problem, wanted);
            }
        }
        this.busy = false;
    }
}
