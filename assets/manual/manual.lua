-- Pandoc's filter of the manual: what code hosts show of docs/*.md becomes what the manual shows.
-- Metadata: chapters (a list of "name.md|number|title"), name (of this document, without .md), book (in the one page that is
-- printed: identifiers begin with the document's name, links stay within the page), figures (folder of the pictures that
-- the documents' commands have made), index (file to which the sections are added for the search).

local chapters, name, book, figures, index = {}, "", false, "", nil
local sections = {}

local function read_metadata(meta)
    for _, line in ipairs(meta.chapters) do
        local file, number, title = pandoc.utils.stringify(line):match("^(.-)|(.-)|(.*)$")
        chapters[file] = { number = number, title = title }
    end
    name = pandoc.utils.stringify(meta.name)
    book = meta.book and true or false
    figures = pandoc.utils.stringify(meta.figures)
    index = meta.index and pandoc.utils.stringify(meta.index)
end

-- $`...`$ in a line.
local function inlines(list)
    local i = 1
    while i + 2 <= #list do
        local before, code, after = list[i], list[i + 1], list[i + 2]
        if before.t == "Str" and code.t == "Code" and after.t == "Str" and before.text:sub(-1) == "$" and
            after.text:sub(1, 1) == "$" then
            local put = { pandoc.Math("InlineMath", code.text) }
            if #before.text > 1 then table.insert(put, 1, pandoc.Str(before.text:sub(1, -2))) end
            -- a word joiner: what follows a formula without a space stays on its line
            if #after.text > 1 then table.insert(put, pandoc.Str("\u{2060}" .. after.text:sub(2))) end
            for _ = 1, 3 do list:remove(i) end
            for k, part in ipairs(put) do list:insert(i + k - 1, part) end
            i = i + math.max(#put - 1, 1) -- what follows the formula may begin another one
        else
            i = i + 1
        end
    end
    return list
end

-- Blocks: formulas, files with their names, commands with the pictures that they make.
local function exists(path)
    local file = io.open(path)
    if file then file:close() end
    return file ~= nil
end

local function pictures(text)
    local found = {}
    for picture in text:gmatch("[%w_/-]+%.svg") do
        local path = figures .. "/" .. name .. "/" .. picture
        if not found[picture] and exists(path) then
            found[picture] = true
            table.insert(found, pandoc.Para { pandoc.Image({ pandoc.Str(picture) }, "made/" .. name .. "/" .. picture) })
        end
    end
    return found
end

-- What prints wide tables has smaller letters in the book, where lines do not scroll.
local function is_wide(text)
    for line in text:gmatch("[^\n]+") do
        if #line > 100 then return true end
    end
    return false
end

local function code_block(block)
    local class = block.classes[1] or ""
    if class == "math" then
        return pandoc.Para { pandoc.Math("DisplayMath", block.text) }
    end
    local language, word = class:match("^(.-):(.*)$")
    local classes = language and { language } or block.classes
    if is_wide(block.text) then table.insert(classes, "wide") end
    block.classes = classes
    local result = { block }
    if word and not word:match("^long") and not word:match("^elsewhere") then
        result = { pandoc.Div({ pandoc.Div({ pandoc.Plain { pandoc.Str(word) } }, pandoc.Attr("", { "name" })), block },
            pandoc.Attr("", { "file" })) }
    end
    if class:match("^sh") or class:match("^console") then
        for _, picture in ipairs(pictures(block.text)) do
            table.insert(result, picture)
        end
    end
    return result
end

-- A link to a document leads to its chapter and, where it said the file's name, says its title.
local function link(element)
    if element.target:match("^%a+:") then
        return element
    end
    local path, anchor = element.target:match("^([^#]*)(#?.*)$")
    local file = path:gsub("^docs/", "")
    if path == "" then
        if book then element.target = "#" .. name .. "--" .. anchor:sub(2) end
        return element
    end
    local chapter = chapters[file]
    if chapter then
        if pandoc.utils.stringify(element):match("([%w-]+%.md)$") == file then
            element.content = { pandoc.Emph { pandoc.Str(chapter.title) } }
        end
        local target = file:gsub("%.md$", "")
        element.target = not book and target .. ".html" .. anchor or
            "#" .. target .. (anchor ~= "" and "--" .. anchor:sub(2) or "")
        return element
    end
    if book then
        return element.content
    end
    path = path:gsub("^%.%./", ""):gsub("/$", "")
    element.target = "files/" .. path ..
        (exists(path .. "/.") and "/index.html" or path:match("%.csv$") and "" or ".txt")
    return element
end

local function header(element)
    if book then
        element.identifier = element.level == 1 and name or name .. "--" .. element.identifier
    end
    if element.level == 1 and chapters[name .. ".md"] then
        element.content:insert(1, pandoc.Span({ pandoc.Str(chapters[name .. ".md"].number) }, pandoc.Attr("", { "number" })))
        element.content:insert(2, pandoc.Space())
    end
    return element
end

-- Wide tables scroll by themselves.
local function wrap_table(element)
    return pandoc.Div({ element }, pandoc.Attr("", { "table" .. #element.colspecs, "table" }))
end

local function quoted(text)
    return '"' .. text:gsub('[\\"]', "\\%0"):gsub("%c", " "):gsub("</", "<\\/") .. '"'
end

-- Of the glossary an entry for each term, which leads to the page that explains it.
local function collect_terms(list)
    for _, item in ipairs(list.content) do
        local term, target
        pandoc.walk_block(pandoc.Div(item), {
            Strong = function(strong) term = term or pandoc.utils.stringify(strong) end,
            Link = function(found) target = found.target:gsub("%.md", ".html") end,
        })
        if term and target then
            table.insert(sections, "[" .. quoted(target) .. ',"Glossary",' .. quoted(term) .. "," ..
                quoted(pandoc.utils.stringify(item)) .. "]")
        end
    end
end

-- One entry for each section: [page, title of the chapter, title, text].
local function collect(document)
    if index then
        local chapter = chapters[name .. ".md"]
        local title, anchor, text = chapter.title, "", {}
        local function finish()
            table.insert(sections, "[" .. quoted(name .. ".html" .. anchor) .. "," .. quoted(chapter.title) .. "," ..
                quoted(title) .. "," .. quoted(table.concat(text, " ")) .. "]")
            text = {}
        end
        for _, block in ipairs(document.blocks) do
            if name == "glossary" and block.t == "BulletList" then
                collect_terms(block)
            elseif block.t == "Header" then
                if block.level > 1 then
                    finish()
                    title, anchor = pandoc.utils.stringify(block), "#" .. block.identifier
                end
            elseif block.t == "CodeBlock" then
                table.insert(text, block.text)
            else
                pandoc.walk_block(pandoc.Div { block }, {
                    Str = function(s) table.insert(text, s.text) end,
                    Code = function(s) table.insert(text, s.text) end,
                })
            end
        end
        finish()
        local file = assert(io.open(index, "a"))
        file:write(table.concat(sections, ",\n"), ",\n")
        file:close()
    end
end

local function drop_comments(element)
    if element.format == "html" and element.text:match("^<!%-%-") then return {} end
end

-- Lines end at no hyphen of a number: 1e-12.
local function number(element)
    if element.text:match("%de%-%d") then return pandoc.Span({ element }, pandoc.Attr("", { "whole" })) end
end

-- A picture of the site leads to itself, so that it can be seen as large as it is.
local function picture(element)
    if not book then return pandoc.Link({ element }, element.src) end
end

return {
    { Meta = read_metadata },
    { Inlines = inlines },
    { Pandoc = collect },
    { CodeBlock = code_block, Link = link, Header = header, Table = wrap_table, RawBlock = drop_comments },
    { Image = picture, Str = number },
}
