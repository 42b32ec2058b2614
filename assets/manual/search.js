"use strict";
// The search of the manual: sections (search-index.js, read at the first search) in which all words occur, those first that
// have them in their titles.
{
    const input = document.querySelector("input[type=search]");
    const list = document.querySelector("#found");
    let reading = false;

    function score(section, words) {
        const [, chapter, title, text] = section;
        const names = (chapter + " " + title).toLowerCase();
        const all = names + " " + text.toLowerCase();
        let sum = 0;
        for (const word of words) {
            if (!all.includes(word))
                return 0;
            sum += names.includes(word) ? 100 : Math.min(20, all.split(word).length - 1);
        }
        return sum;
    }

    function excerpt(text, word) {
        const at = Math.max(0, text.toLowerCase().indexOf(word));
        return (at > 40 ? "… " : "") + text.slice(Math.max(0, at - 40), at + 80) + " …";
    }

    function show() {
        const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
        const found = words.length === 0 ? [] : window.manualIndex.map(section => [score(section, words), section])
            .filter(pair => pair[0] > 0).sort((a, b) => b[0] - a[0]).slice(0, 20);
        list.hidden = words.length === 0;
        list.replaceChildren(...found.map(([, [page, chapter, title, text]]) => {
            const item = document.createElement("li");
            const link = document.createElement("a");
            const where = document.createElement("small");
            link.href = page;
            link.textContent = title === chapter ? title : chapter + ": " + title;
            where.textContent = excerpt(text, words[0]);
            item.append(link, where);
            return item;
        }));
        if (words.length > 0 && found.length === 0)
            list.textContent = "Nothing found.";
    }

    function search() {
        if (window.manualIndex)
            return show();
        if (reading)
            return;
        reading = true;
        const script = document.createElement("script");
        script.src = "search-index.js";
        script.onload = show;
        document.head.append(script);
    }

    input.addEventListener("input", search);
    // A link to a search: page.html?q=words.
    input.value = new URLSearchParams(location.search).get("q") ?? "";
    if (input.value)
        search();
    // On wide screens the list of chapters stands open.
    if (window.matchMedia("(min-width: 72rem)").matches)
        document.querySelector("nav details").open = true;
    document.querySelector("nav [aria-current]")?.scrollIntoView({ block: "nearest" });
}
