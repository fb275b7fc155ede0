// The server gives its token to the page once; the window keeps it for when it is loaded again, the address does not.
const KEY = "centrode.token";
const given = JSON.parse(document.querySelector<HTMLMetaElement>('meta[name="workbench"]')?.content || "{}") as { token?: string; refused?: string };
const keptToken = (): string => {
  try {
    if (given.token) sessionStorage.setItem(KEY, given.token);
    return given.token ?? sessionStorage.getItem(KEY) ?? "";
  } catch {
    return given.token ?? ""; // a forbidden store
  }
};
export const token = keptToken();
export const refusal = given.refused ?? ""; // what to do where the token is that of no server
const query = new URLSearchParams(location.search);
if (query.has("token") || query.has("code")) {
  query.delete("token");
  query.delete("code");
  window.history.replaceState(null, "", `${location.pathname}${query.size ? `?${query}` : ""}${location.hash}`);
}
